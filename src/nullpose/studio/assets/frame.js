// Runs before viser. It tells viser where its websocket is, shows the overlay and the state of the connection,
// sends what is typed, asks before a changed scene is left, folds the panel on a phone, says what is under the
// pointer, draws Undo and Redo, explains the scene once, and turns it while it is presented.
(() => {
  "use strict";
  const ASK_MS = 2000, POINT_MS = 40, PRESENT_MS = 1500, RADIANS_PER_MS = 2 * Math.PI / 40_000;
  const WORDS = {
    connecting: "connecting",
    connected: "connected",
    reconnecting: "reconnecting; the scene then begins anew",
    behind: "not connected; begins anew when this window is in front",
    ended: "not connected: the studio was ended or cannot be reached; a new one prints a new address to open",
    restarted: "not connected: the studio was ended or restarted; open the address that the new one prints",
  };
  const query = new URLSearchParams(location.search);
  const token = query.get("token");

  function address(websocket) {
    for (const name of ["dark", "websocket"]) query.delete(name);
    if (websocket) query.set("websocket", websocket);
    history.replaceState(null, "", `?${query}`);
  }

  const own = new URLSearchParams({ token });
  if (matchMedia("(prefers-color-scheme: dark)").matches) own.set("dark", "1");
  address(`ws://${location.host}/?${own}`);

  const overlay = document.createElement("div");
  overlay.id = "np-overlay";
  overlay.innerHTML = '<div data-np="overlay"><div class="np-status">solving</div></div><div data-np="connection" role="status"></div>';
  const line = overlay.lastChild;
  const tip = document.createElement("div");
  tip.id = "np-tip";
  tip.setAttribute("role", "tooltip");

  function tell(state) {
    overlay.dataset.state = state;
    if (line.textContent !== WORDS[state]) line.textContent = WORDS[state];
  }

  let asking = false;
  async function ask() {
    asking = true;
    while (overlay.dataset.state !== "connected") {
      let state = "reconnecting";
      try {
        const answer = await fetch(`/alive?token=${token}`, { cache: "no-store" });
        state = answer.ok ? (document.hasFocus() ? "reconnecting" : "behind") : "restarted";
      } catch {
        state = "ended";
      }
      if (overlay.dataset.state === "connected") break;
      tell(state);
      await new Promise((resume) => setTimeout(resume, ASK_MS));
    }
    asking = false;
  }

  function show(message) {
    const content = (message.props ?? message.updates)?.content;
    if (typeof content !== "string") return;
    if (content.startsWith('<div data-np="overlay"')) {
      overlay.firstChild.outerHTML = content;
      root.classList.add("np-ready"); // the panel is ours by now
      present();
      explain();
    }
    if (content.startsWith('<div data-np="tip"')) {
      tip.innerHTML = content;
      tip.hidden = !tip.innerText.trim();
      root.classList.toggle("np-grip", Boolean(tip.firstChild.dataset.key));
    }
  }

  // Where the pointer is, as shares of the canvas, for the studio to say what is there.
  const root = document.documentElement;
  const drawn = () => document.querySelector("canvas[data-engine]");
  let pointer, sent = "", timer; // the control that takes the place; the last place sent; the delay
  function point(event) {
    const box = drawn()?.getBoundingClientRect();
    const isOver = event.target instanceof HTMLCanvasElement && event.pointerType === "mouse" && !event.buttons;
    if (!pointer || !box) return;
    const at = isOver ? [(event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height] : [];
    if (!isOver) tip.hidden = true;
    tip.style.left = `${Math.min(event.clientX + 16, box.right - 220)}px`;
    tip.style.top = `${Math.min(event.clientY + 16, box.bottom - 120)}px`;
    clearTimeout(timer);
    timer = setTimeout(() => {
      const place = at.map((share) => share.toFixed(5)).join(" ");
      if (place !== sent) socket.type(pointer, sent = place);
    }, POINT_MS);
  }
  for (const kind of ["pointermove", "pointerdown"]) addEventListener(kind, point, true);

  // Undo and Redo in the panel's head press buttons that the panel does not show.
  const steps = document.createElement("span");
  steps.id = "np-steps";
  const icons = {};
  for (const [name, keys, turn] of [["Undo", "Ctrl+Z", ""], ["Redo", "Ctrl+Shift+Z", "matrix(-1 0 0 1 24 0)"]]) {
    const icon = icons[name] = document.createElement("button");
    icon.title = `${name} (${keys})`;
    icon.ariaLabel = name;
    icon.innerHTML = `<svg viewBox="0 0 24 24"><path transform="${turn}" d="M9 14l-4-4 4-4M5 10h11a4 4 0 1 1 0 8h-1"/></svg>`;
    icon.addEventListener("click", () => socket.type(icon.name, true));
    steps.append(icon);
  }
  for (const kind of ["pointerdown", "mousedown", "click"]) steps.addEventListener(kind, (event) => event.stopPropagation());
  function head(message) {
    const icon = icons[message.props?.label] ?? Object.values(icons).find((each) => each.name === message.uuid);
    if (message.type === "GuiButtonMessage" && icon) icon.name = message.uuid;
    const isDisabled = (message.props ?? message.updates)?.disabled;
    if (icon?.name === message.uuid && isDisabled !== undefined) icon.disabled = isDisabled;
  }

  // While the scene is presented it turns about its centre, until a hand takes the camera.
  let turning;
  function present() {
    const centre = overlay.firstChild.dataset.centre?.split(" ").map(Number);
    if (!centre === !turning) return;
    cancelAnimationFrame(turning);
    turning = undefined;
    if (!centre) return;
    let before, isHeld = matchMedia("(prefers-reduced-motion: reduce)").matches;
    addEventListener("pointerdown", (event) => { isHeld ||= event.target instanceof HTMLCanvasElement; }, { once: true });
    const begins = performance.now() + PRESENT_MS; // the panel folds first, and the camera is aimed anew
    const turn = (now) => {
      turning = requestAnimationFrame(turn);
      const { cameraControl: camera, nodeRefFromName: nodes } = window.__viserMutable ?? {};
      if (isHeld || !camera || !nodes[""] || now < begins) return;
      const about = nodes[""].localToWorld(camera.getPosition(nodes[""].position.clone()).set(...centre));
      const angle = Math.min(100, now - (before ?? now)) * RADIANS_PER_MS, up = about.clone().set(0, 1, 0);
      before = now;
      const place = (each) => each.sub(about).applyAxisAngle(up, angle).add(about).toArray();
      camera.setLookAt(...place(camera.getPosition(about.clone())), ...place(camera.getTarget(about.clone())), false);
    };
    turning = requestAnimationFrame(turn);
  }

  // What there is to see, once: three numbers in the scene and what they say.
  const NOTES = [ // what they stand at, and the words
    ["/drone-a/body", "<b>The drone</b>, where its worst node is heard best; around it its antenna's pattern."],
    ["/drone-a/angle", "<b>The null</b>, orange: along it the antenna hears nothing, so it goes to the jamming."],
    ["/points/nodes-0", "<b>Nodes</b> (squares) transmit, <b>jammers</b> (X) disturb. Drag one: the drone follows."],
  ];
  const notes = document.createElement("div");
  notes.id = "np-notes";
  notes.innerHTML = `<ol>${NOTES.map(([, words]) => `<li>${words}</li>`).join("")}</ol><button>Got it</button>`;
  const signs = NOTES.map((_, i) => Object.assign(document.createElement("i"), { className: "np-sign", textContent: i + 1 }));
  let isExplained = Boolean(localStorage.getItem("np-explained"));
  function explain() {
    if (isExplained || !overlay.querySelector("[data-np=overlay-value-0]")) return;
    isExplained = true;
    document.body.append(notes, ...signs);
    const keep = () => {
      const { nodeRefFromName: nodes, camera } = window.__viserMutable ?? {}, box = drawn()?.getBoundingClientRect();
      if (!notes.isConnected) return;
      requestAnimationFrame(keep);
      signs.forEach((sign, i) => {
        const node = nodes?.[NOTES[i][0]];
        sign.hidden = !node || !box;
        if (sign.hidden) return;
        const at = node.getWorldPosition(camera.position.clone()).project(camera);
        sign.style.left = `${box.x + (0.5 + 0.5 * at.x) * box.width}px`;
        sign.style.top = `${box.y + (0.5 - 0.5 * at.y) * box.height}px`;
      });
    };
    keep();
  }
  notes.lastChild.addEventListener("click", () => {
    localStorage.setItem("np-explained", "1");
    [notes, ...signs].forEach((each) => each.remove());
  });

  addEventListener("beforeunload", (event) => { // the first version is the scene that the studio was started with
    if (overlay.firstChild.dataset.version > 1) event.preventDefault();
  });

  // viser's own limit for its sheet at the bottom; asked for late, since a phone is as wide as a desk's screen
  // until the page has said how wide it is
  const sheet = matchMedia("(max-width: 36em)");
  let folds = true; // whether the sheet is to be folded as soon as it is there
  const title = () => document.querySelector("svg.tabler-icon-cloud-check")?.parentElement;
  function fold() {
    const handle = title();
    if (!folds || !sheet.matches || !handle) return;
    folds = false;
    if (handle.querySelector("button:not(#np-steps *)")) handle.click(); // folded, it has none
  }
  sheet.addEventListener("change", () => { // the phone was turned, and the sheet is a new one
    folds = true;
    setTimeout(fold, 100);
  });

  // What is typed. viser gathers all messages of 50 ms and sends only the last of them, so that of 36 and Enter
  // the 6 could be lost. Here the whole text of a field is sent, once: with Enter, or when the field is left.
  const texts = new Map(); // what the studio has last set, by the names of the fields
  let socket, typing; // the worker with the websocket; the field whose text is not sent yet

  function nameOf(field) {
    let at = field.parentElement;
    while (at && !at.querySelector("label[for]")) at = at.parentElement;
    const name = at?.querySelector("label[for]").htmlFor;
    return texts.has(name) ? name : undefined;
  }

  function take() {
    const field = typing;
    typing = undefined;
    const name = field?.isConnected && nameOf(field);
    if (name && field.value !== texts.get(name)) socket.type(name, field.value);
  }

  function putBack() {
    const field = typing;
    typing = undefined;
    const write = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;
    write.call(field, texts.get(nameOf(field)) ?? field.value); // as a hand does, so that viser sees it
    field.dispatchEvent(new InputEvent("input", { bubbles: true }));
    typing = undefined;
  }

  addEventListener("input", (event) => { if (nameOf(event.target)) typing = event.target; }, true);
  addEventListener("focusout", (event) => { if (event.target === typing) take(); }, true);
  addEventListener("pointerdown", (event) => { if (typing && event.target !== typing) take(); }, true);
  addEventListener("keydown", (event) => {
    if (event.target !== typing || event.isComposing) return;
    if (event.key === "Enter") take();
    if (event.key === "Escape") putBack();
  }, true);

  function set(message) {
    if (message.type === "GuiTextMessage" && message.props.label === "Pointer") pointer = message.uuid;
    else if (message.type === "GuiTextMessage") texts.set(message.uuid, message.value);
    if (message.type !== "GuiUpdateMessage" || !texts.has(message.uuid) || !("value" in message.updates)) return;
    texts.set(message.uuid, message.updates.value);
    if (typing?.isConnected && nameOf(typing) === message.uuid) delete message.updates.value; // it is the hand's
  }

  function hear(data, worker) {
    if (data?.type === "connected") {
      socket = worker;
      texts.clear();
      tell("connected");
      address();
      setTimeout(fold, 0);
    } else if (data?.type === "closed") {
      if (!asking) {
        tell("reconnecting");
        ask();
      }
    } else if (data?.type === "message_batch") {
      data.messages.forEach(show);
      data.messages.forEach(set);
      data.messages.forEach(head);
      // what viser folds is its panel beside the scene, and not the sheet
      folds ||= data.messages.some((one) => one.type === "GuiSetPanelCollapsedMessage" && one.collapsed);
      fold();
      const header = title();
      if (header && !header.contains(steps)) header.append(steps);
    }
  }

  // viser's worker has the websocket; what it says to the page is heard here too, whatever the panel shows
  window.Worker = class extends window.Worker {
    constructor(...given) {
      super(...given);
      this.addEventListener("message", (event) => hear(event.data, this));
    }

    postMessage(data, ...more) {
      const isKey = data?.message?.type === "GuiUpdateMessage" && texts.has(data.message.uuid);
      if (data?.message?.type === "ViewerCameraMessage") { // which has the pixels of the screen, finer than the page's
        const { clientWidth, clientHeight } = document.querySelector("canvas[data-engine]");
        Object.assign(data.message, { image_width: clientWidth, image_height: clientHeight });
      }
      if (!isKey) super.postMessage(data, ...more);
    }

    type(uuid, value) {
      const message = { type: "GuiUpdateMessage", uuid, updates: { value } };
      super.postMessage({ type: "send", message });
    }
  };

  addEventListener("DOMContentLoaded", () => {
    tell("connecting");
    document.body.append(overlay, tip);
    // viser's notices are below the overlay
    const measure = () =>
      document.documentElement.style.setProperty("--np-height", `${overlay.offsetHeight}px`);
    new ResizeObserver(measure).observe(overlay);
  });
})();
