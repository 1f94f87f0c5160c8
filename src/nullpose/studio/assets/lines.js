// Runs before viser. Lines are drawn in the colours that they are given, which are the legend's: without this
// they would be made to look as on film (ACES), which the map and the legend are not.
(() => {
  "use strict";
  const context = WebGL2RenderingContext.prototype;
  const given = context.shaderSource;
  context.shaderSource = function (shader, text) {
    const ofLines = text.includes("worldStart");
    given.call(this, shader, ofLines ? text.replace("return ACESFilmicToneMapping( color );", "return color;") : text);
  };
})();
