// Paths, and the robot on them.
let ways = [];
function loadPaths() {
  for (const { way, shadow } of ways) for (const { id } of [way, shadow]) gl.deleteBuffer(id);
  ways = data.paths.map((path) => ({
    way: strip(path.way),
    shadow: strip(path.way.map((p) => [p[0], p[1], floor])),
  }));
}
if (gl) loadPaths();

// Between two frames the poses are blended.
function posesAt(place) {
  const { frames } = path();
  const i = Math.min(Math.floor(place), frames.length - 2), t = place - i;
  const [a, b] = [frames[i], frames[i + 1]];
  return data.links.map((_, link) => {
    const blend = (at, sign) => a[7 * link + at] * (1 - t) + sign * b[7 * link + at] * t;
    const same = [3, 4, 5, 6].reduce((sum, at) => sum + a[7 * link + at] * b[7 * link + at], 0);
    const q = [3, 4, 5, 6].map((at) => blend(at, same < 0 ? -1 : 1));
    const length = Math.hypot(...q);
    return placed([0, 1, 2].map((at) => blend(at, 1)), q.map((x) => x / length));
  });
}
// Of a model without bodies: dots at the start, at the goal, and between them where the path is now.
function drawPlaces(camera) {
  const { way } = path(), i = Math.min(Math.floor(state.place), last() - 1), t = state.place - i;
  const now = way[i].map((x, axis) => x + (way[i + 1][axis] - x) * t);
  const tints = [AMBER, WINE, WAY].map((rgb) => [...rgb.map((x) => 255 * x), 255]);
  drawDots(camera, [way[0], way[last()], now], tints, 13);
}
function drawRobotAt(place, opacity) {
  const share = place / last();
  drawRobot(posesAt(place), AMBER.map((x, i) => (x + (WINE[i] - x) * share) * 1.05), opacity);
}
