// One picture, painted when something has changed, and only then.
const dark = matchMedia("(prefers-color-scheme: dark)");
const way = gl && (() => {
  const middles = data.told.map((_, frame) => {
    const v = verticesAt(frame), sum = [0, 0, 0];
    v.forEach((x, i) => { sum[i % 3] += x / count; });
    return sum;
  });
  return strip(middles);
})();
let isWanted = false;
function repaint() {
  if (!gl || isWanted) return;
  isWanted = true;
  requestAnimationFrame(() => { isWanted = false; paint(); });
}
function paint() {
  const [w, h] = [Math.round(canvas.clientWidth * pixels()), Math.round(canvas.clientHeight * pixels())];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  const { camera, from, right, up, toward } = look();
  const light = unit(toward.map((x, i) => 0.5 * x - 0.45 * right[i] + 0.75 * up[i]));
  const ground = getComputedStyle(canvas).backgroundColor.match(/[\d.]+/g).map((x) => x / 255);
  INK.splice(0, 3, ...(dark.matches ? [0.8, 0.82, 0.85] : [0.2, 0.22, 0.25]));
  shapeAt(placeNow(), element("show-mesh").checked ? mesh : creases);
  gl.viewport(0, 0, w, h);
  gl.clearColor(ground[0], ground[1], ground[2], 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  drawBody(camera, from, light);
  const { made, at } = programs.plain;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform3f(at.eye, ...from);
  gl.uniform3f(at.light, ...light);
  draw(shape.lines, gl.LINES, element("show-mesh").checked ? [0.15, 0.1, 0.1, 0.35] : [0.15, 0.1, 0.1, 0.75], IDENTITY, 0.0004);
  drawWide(way, gl.LINE_STRIP, [...(dark.matches ? [0.95, 0.5, 0.6] : WAY), 1]);
  drawObstacles();
  // The way as seen through everything.
  gl.disable(gl.DEPTH_TEST);
  draw(way, gl.LINE_STRIP, [...(dark.matches ? [0.95, 0.5, 0.6] : WAY), 0.4]);
}
