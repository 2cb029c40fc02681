// Drawing a hint: the robot is moved by hand, and its configurations are kept at regular intervals of its motion. Whatever the robot is, its base is
// moved and its joints stay as they are.
const hint = { on: false, now: null, kept: [], strokes: [], since: 0 };
const canDraw = () => !!data.hand && !!handStart();

// Where drawing begins: at the node that was clicked, or else at the start of the problem's query, at the path's place, or at the first node.
function handStart() {
  const { start } = data.hand, count = data.dofs.length, links = data.links.length;
  const ofNode = (node) => ({ config: [...graph.configs.subarray(count * node, count * (node + 1))],
    poses: [...graph.poses.subarray(7 * links * node, 7 * links * (node + 1))], marker: [...markerOf(node)] });
  if (graph && state.chosen >= 0) return ofNode(state.chosen);
  if (start) return start;
  if (path()) { const i = Math.round(state.place); return { config: path().configs[i], poses: path().frames[i], marker: path().way[i] }; }
  return graph && graph.count ? ofNode(0) : null;
}
const copied = ({ config, poses, marker }) => ({ config: [...config], poses: [...poses], marker: [...marker] });

// Kept is a configuration after every two-hundredth of the scene's size or twentieth of a radian, and at the end of a stroke.
const HAND_STEP = size / 200, HAND_TURN = 0.05;
function keepHand(isEnd) {
  if (hint.since < 1 && !(isEnd && hint.since > 0)) return;
  hint.kept.push(copied(hint.now));
  hint.since = 0;
}
function beginStroke() { hint.strokes.push(hint.kept.length); }
function endStroke() {
  keepHand(true);
  // A click alone is no stroke.
  if (hint.strokes[hint.strokes.length - 1] === hint.kept.length) hint.strokes.pop();
  tellAll();
}
function moveHand(by) {
  const { config, poses, marker } = hint.now, { translations } = data.hand;
  const way = by.map((x, axis) => axis < translations ? x : 0);
  for (let axis = 0; axis < translations; axis++) config[axis] += way[axis];
  for (let i = 0; i < poses.length; i += 7) way.forEach((x, axis) => { poses[i + axis] += x; });
  way.forEach((x, axis) => { marker[axis] += x; });
  hint.since += Math.hypot(...way) / HAND_STEP;
  keepHand(false);
}
// The product of two quaternions: first `b`, then `a`.
const turnedBy = ([w, x, y, z], [a, b, c, d]) => [w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
  w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a];
// Turns about the base's position.
function turnHand(axis, angle) {
  const { config, poses, marker } = hint.now, { translations, turns } = data.hand;
  if (!turns) return;
  if (planar) axis = [0, 0, 1];
  const half = Math.sin(angle / 2), by = [Math.cos(angle / 2), ...axis.map((x) => x * half)];
  const base = [0, 1, 2].map((i) => i < translations ? config[i] : 0);
  const about = (p) => {
    const from = sub(p, base), across = cross(axis, from), along = dot(axis, from);
    return base.map((x, i) => x + from[i] * Math.cos(angle) + across[i] * Math.sin(angle) + axis[i] * along * (1 - Math.cos(angle)));
  };
  const set = (numbers, at, values) => values.forEach((x, i) => { numbers[at + i] = x; });
  if (planar) config[translations] = Math.atan2(Math.sin(config[translations] + angle), Math.cos(config[translations] + angle));
  else set(config, translations, unit(turnedBy(by, config.slice(translations, translations + 4))));
  for (let i = 0; i < poses.length; i += 7) {
    set(poses, i, about(poses.slice(i, i + 3)));
    set(poses, i + 3, unit(turnedBy(by, poses.slice(i + 3, i + 7))));
  }
  set(marker, 0, about(marker));
  hint.since += Math.abs(angle) / HAND_TURN;
  keepHand(false);
}
// The pointer's motion in pixels of the page: in the plane of the screen, at the robot's distance; or a turn about the screen's axes.
function dragHand(x, y, turns) {
  const { from, right, up, toward } = look();
  if (turns && planar) turnHand(toward, (x - y) * 0.01);
  else if (turns) { turnHand(up, x * 0.01); turnHand(right, y * 0.01); }
  else {
    const by = 2 * dot(sub(from, hint.now.marker), toward) * Math.tan(FIELD / 2) / canvas.clientHeight;
    moveHand([0, 1, 2].map((i) => (right[i] * x - up[i] * y) * by));
  }
}
// The wheel moves in depth, or turns about the line of sight; in the plane it turns.
function wheelHand(by, turns) {
  const { toward } = look();
  beginStroke();
  if (turns || planar) turnHand(toward, by * 0.001);
  else moveHand(toward.map((x) => x * by * size * 0.0002));
  endStroke();
}

// The hint as `--hint` and the generator `hints` read it: a line of the degrees of freedom, and a configuration a line.
function hintText() {
  const field = (text) => /[",\r\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
  const lines = [data.dofs.map(([name, unit]) => field(name + " [" + unit + "]")), ...hint.kept.map(({ config }) => config)];
  return lines.map((fields) => fields.join(",") + "\n").join("");
}
function saveHint() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([hintText()], { type: "text/csv" }));
  link.download = data.name + "-hint.csv";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
function toggleHint() {
  hint.on = !hint.on;
  if (hint.on && !hint.kept.length) hint.kept.push(copied(hint.now = copied(handStart())));
  state.playing = false;
  tellAll();
}
function undoHint() {
  if (!hint.strokes.length) return;
  hint.kept.length = hint.strokes.pop();
  restoreHand();
}
function clearHint() {
  const start = copied(handStart());
  hint.kept = [start];
  hint.strokes = [];
  restoreHand();
}
function restoreHand() {
  hint.now = copied(hint.kept[hint.kept.length - 1]);
  hint.since = 0;
  tellAll();
}

// The robot where the hand has it, some robots where it was, and the way of its reference point.
const GHOSTS = 24;
const matrices = ({ poses }) => data.links.map((_, link) => placed(poses.slice(7 * link, 7 * link + 3), poses.slice(7 * link + 3, 7 * link + 7)));
function drawHint(camera, colour) {
  if (!hint.on) return;
  const { kept, now } = hint, count = Math.min(GHOSTS, kept.length);
  drawRobot(matrices(now), colour, 1);
  gl.depthMask(false);
  for (let i = 0; i < count; i++) drawRobot(matrices(kept[Math.floor(i * kept.length / count)]), AMBER, 0.1);
  gl.disable(gl.DEPTH_TEST);
  const way = strip([...kept, now].map(({ marker }) => marker));
  drawWide(way, gl.LINE_STRIP, [...WAY, 1]);
  gl.deleteBuffer(way.id);
  const tint = [...WAY.map((x) => 255 * x), 255];
  drawDots(camera, kept.map(({ marker }) => marker), kept.map(() => tint), 6);
  gl.enable(gl.DEPTH_TEST);
  gl.depthMask(true);
}
function tellHint() {
  element("draw").hidden = !canDraw();
  element("draw").textContent = hint.on ? "End drawing" : "Draw a hint";
  canvas.classList.toggle("drawing", hint.on);
  element("hint").hidden = !hint.on;
  if (!hint.on) return;
  element("drawn").textContent = counted(hint.kept.length, "configuration");
  element("undo").disabled = !hint.strokes.length;
  const turns = !data.hand.turns ? "" : planar ? ", shift-drag or the wheel turns it" : ", shift-drag turns it";
  element("how").textContent = "Drag moves the robot" + turns + (planar ? "" : ", the wheel moves it in depth") + "; with ctrl they move the view. "
    + (data.live ? "It is red where it collides." : "Collisions are not tested here.");
}
for (const [id, act] of [["draw", toggleHint], ["undo", undoHint], ["clear", clearHint], ["save", saveHint]])
  element(id).addEventListener("click", act);
