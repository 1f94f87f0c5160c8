// The contrast (WCAG 2) of every text that is seen with the colours behind it, but of what is disabled.
() => {
  const colour = (text) => { const [red, green, blue, alpha] = text.match(/[\d.]+/g).map(Number); return [red, green, blue, alpha ?? 1]; };
  const over = (upper, lower) => [0, 1, 2].map((i) => upper[3] * upper[i] + (1 - upper[3]) * lower[i]).concat(1);
  const linear = (part) => (part /= 255) <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  const luminance = ([red, green, blue]) => 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
  const page = document.documentElement.dataset.mantineColorScheme === "dark" ? [20, 20, 20, 1] : [255, 255, 255, 1];
  const found = [];
  function measure(element, text) {
    const box = element.getBoundingClientRect();
    if (!text || !box.width || !box.height || !element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) return;
    let ground = page, opacity = 1;
    const above = [];
    for (let at = element; at; at = at.parentElement) {
      if (at.matches(":disabled, [data-disabled], script, style")) return;
      above.unshift(getComputedStyle(at));
    }
    for (const style of above) { ground = over(colour(style.backgroundColor), ground); opacity *= style.opacity; }
    const style = getComputedStyle(element), ink = colour(element instanceof SVGElement ? style.fill : style.color);
    ink[3] *= opacity;
    const [low, high] = [luminance(over(ink, ground)), luminance(ground)].sort((one, other) => one - other);
    found.push({ text: text.slice(0, 40), ratio: (high + 0.05) / (low + 0.05) });
  }
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) measure(texts.currentNode.parentElement, texts.currentNode.textContent.trim());
  for (const field of document.querySelectorAll("input:not([type=checkbox])")) measure(field, field.value);
  return found;
}
