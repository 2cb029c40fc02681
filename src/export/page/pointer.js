// The pointer, fingers and keys. In 3D dragging turns, in a plane it moves; shift or the right button does the other.
const fingers = new Map();
let isDragged = false;
// Whether the robot is dragged, while a hint is drawn; ctrl leaves the pointer to the view.
let isByHand = false;
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  isDragged = fingers.size > 1;
  if (isByHand) endStroke();
  isByHand = hint.on && !isDragged && !event.ctrlKey;
  if (isByHand) beginStroke();
});
const spread = () => {
  const [a, b] = [...fingers.values()];
  return { apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1, at: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] };
};
canvas.addEventListener("pointermove", (event) => {
  const was = fingers.get(event.pointerId);
  if (!was) { hover(event.pointerType === "touch" ? -1 : nodeAt(event.clientX, event.clientY)); return; }
  const old = fingers.size === 2 ? spread() : null;
  const [x, y] = [event.clientX - was[0], event.clientY - was[1]];
  if (!isDragged && Math.hypot(x, y) < 4) return;
  isDragged = true;
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  if (old) {
    const { apart, at } = spread();
    zoomBy(old.apart / apart);
    moveBy(at[0] - old.at[0], at[1] - old.at[1]);
  } else if (isByHand) {
    dragHand(x, y, event.shiftKey || (event.buttons & 6) !== 0);
    tellHint();
    tellTouch();
    tellValues();
  } else if (planar !== (event.shiftKey || (event.buttons & 6) !== 0)) moveBy(x, y);
  else turnBy(x, y);
  repaint(true);
});
for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => {
  if (isByHand) {
    isByHand = false;
    endStroke();
  } else if (kind === "pointerup" && !isDragged && event.button === 0) {
    const node = nodeAt(event.clientX, event.clientY);
    state.chosen = node === state.chosen ? -1 : node;
    tellAll();
  }
  fingers.delete(event.pointerId);
});
canvas.addEventListener("pointerleave", () => hover(-1));
function hover(node) {
  if (node === state.hovered) return;
  state.hovered = node;
  tellValues();
  repaint();
}
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (hint.on && !event.ctrlKey) wheelHand(event.deltaY, event.shiftKey);
  else zoomBy(Math.exp(event.deltaY * 0.001));
  repaint(true);
}, { passive: false });
const STEPS = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
window.addEventListener("keydown", (event) => {
  const on = event.target.tagName;
  if (event.code === "Space" && !hint.on && on !== "BUTTON" && on !== "SUMMARY" && on !== "INPUT") {
    event.preventDefault();
    toggle();
  }
  if (event.code === "Escape") { state.chosen = -1; tellAll(); }
  if (event.target !== canvas) return;
  const step = STEPS[event.code];
  if (step) (planar !== event.shiftKey ? moveBy : turnBy)(...step);
  else if (event.key === "+" || event.key === "-") zoomBy(event.key === "+" ? 0.9 : 1 / 0.9);
  else return;
  event.preventDefault();
  repaint(true);
});
