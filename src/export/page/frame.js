// One picture. It is painted when something has changed, and only then. Where that takes long, as without a graphics card,
// a part of the edges is drawn while things move, and all of them once they rest.
const SLOW = 60, REST = 300;
let isWanted = false, isSlow = false, isCoarse = false, rest = null;
function repaint(moving) {
  if (!gl) return;
  clearTimeout(rest);
  isCoarse = moving === true && isSlow;
  if (isWanted) return;
  isWanted = true;
  requestAnimationFrame((now) => {
    isWanted = false;
    advance(now);
    const begun = performance.now();
    paint();
    // What was drawn is asked for, so that the card has finished before the time is taken.
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    const time = performance.now() - begun;
    element("time").textContent = time.toFixed(1) + " ms";
    if (isCoarse) rest = setTimeout(repaint, REST);
    else isSlow = time > SLOW;
  });
}
function usePlain(camera, from, light) {
  const { made, at } = programs.plain;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform3f(at.eye, ...from);
  gl.uniform3f(at.light, ...light);
}
function paint() {
  const [w, h] = [Math.round(canvas.clientWidth * pixels()), Math.round(canvas.clientHeight * pixels())];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  const { camera, from, right, up, toward } = look();
  const light = unit(toward.map((x, i) => 0.5 * x - 0.45 * right[i] + 0.75 * up[i]));
  gl.viewport(0, 0, w, h);
  gl.clearColor(0.984, 0.98, 0.965, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

  const played = !hint.on && path() && ways[state.path], node = pointed();
  gl.depthMask(false);
  drawEnergy(camera);
  usePlain(camera, from, light);
  drawFloor();
  if (played) draw(played.shadow, gl.LINE_STRIP, [...INK, 0.25]);
  gl.depthMask(true);
  if (planar) drawObstacles();
  // From above, nodes and edges lie on top of what stands on the plane.
  if (planar) gl.disable(gl.DEPTH_TEST);
  drawRoadmap(camera);
  if (planar) gl.enable(gl.DEPTH_TEST);
  drawCrowd(camera, from, light);
  usePlain(camera, from, light);
  if (node >= 0) drawRobot(posesOf(node), TEAL, 1);
  drawHint(camera, handColour());
  usePlain(camera, from, light);
  if (played) {
    drawRobotAt(state.place, node >= 0 ? 0.35 : 1);
    if (!planar) drawWide(played.way, gl.LINE_STRIP, [...WAY, 1]);
  }
  if (!planar) drawObstacles();
  gl.depthMask(false);
  if (played) {
    drawRobotAt(0, 0.22);
    drawRobotAt(last(), 0.22);
    // The way as seen through everything.
    gl.disable(gl.DEPTH_TEST);
    if (planar) drawWide(played.way, gl.LINE_STRIP, [...WAY, 1]);
    else draw(played.way, gl.LINE_STRIP, [...WAY, 0.4]);
  }
  gl.disable(gl.DEPTH_TEST);
  if (played && !data.links.length) drawPlaces(camera);
  drawPointed(camera);
  gl.depthMask(true);
}
