// Runs before viser. It tells viser where its websocket is, shows the overlay and the state of the connection,
// sends what is typed, asks before a changed scene is left, and folds the panel on a phone.
(() => {
  "use strict";
  const ASK_MS = 2000;
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
  overlay.innerHTML = '<div data-np="overlay"></div><div data-np="connection" role="status"></div>';
  const line = overlay.lastChild;

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
    if (typeof content !== "string" || !content.startsWith('<div data-np="overlay"')) return;
    overlay.firstChild.outerHTML = content;
  }

  addEventListener("beforeunload", (event) => { // the first version is the scene that the studio was started with
    if (overlay.firstChild.dataset.version > 1) event.preventDefault();
  });

  // viser's own limit for its sheet at the bottom; asked for late, since a phone is as wide as a desk's screen
  // until the page has said how wide it is
  const sheet = matchMedia("(max-width: 36em)");
  let folds = true; // whether the sheet is to be folded as soon as it is there
  function fold() {
    const handle = document.querySelector("svg.tabler-icon-cloud-check")?.parentElement;
    if (!folds || !sheet.matches || !handle) return;
    folds = false;
    if (handle.querySelector("button")) handle.click(); // folded, it has none
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
    if (message.type === "GuiTextMessage") texts.set(message.uuid, message.value);
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
      // what viser folds is its panel beside the scene, and not the sheet
      folds ||= data.messages.some((one) => one.type === "GuiSetPanelCollapsedMessage" && one.collapsed);
      fold();
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
    document.body.append(overlay);
    // viser's notices are below the overlay
    const measure = () =>
      document.documentElement.style.setProperty("--np-height", `${overlay.offsetHeight}px`);
    new ResizeObserver(measure).observe(overlay);
  });
})();
