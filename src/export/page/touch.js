// Whether the robot that is moved by hand collides. Whoever serves the page knows it: at once an estimate, which goes on from the last exact
// answer, and soon after the exact answer. A page that is a file has nobody to ask.
const UNTOLD = { collides: null, exact: false, at: "" };
const touch = { ...UNTOLD, asking: false, failed: false };
const TOUCH_PAUSE = 20, TOUCH_PAUSE_MAX = 640;
const handText = () => hint.now.config.join(",");
const isSettled = () => touch.exact && touch.at === handText();
// One question at a time, until the exact answer for the place where the robot stands is there: ever more seldom while the robot stands still.
async function askTouch() {
  if (!data.live || !hint.on || touch.asking || touch.failed || isSettled()) return;
  touch.asking = true;
  let pause = TOUCH_PAUSE;
  try {
    do {
      const at = handText(), answer = await fetch("collides?q=" + at, { cache: "no-store" });
      if (!answer.ok) throw new Error();
      const { collides, exact } = await answer.json();
      pause = touch.at === at ? Math.min(2 * pause, TOUCH_PAUSE_MAX) : TOUCH_PAUSE;
      Object.assign(touch, { collides, exact, at });
      sayTouch();
      repaint();
      if (!exact) await new Promise((goOn) => setTimeout(goOn, pause));
    } while (hint.on && !isSettled());
  } catch {
    // Nobody is asked again before drawing begins anew.
    Object.assign(touch, UNTOLD, { failed: true });
    sayTouch();
    repaint();
  }
  touch.asking = false;
}
const handColour = () => touch.collides ? [0.86, 0.16, 0.14] : AMBER;
function tellTouch() {
  if (!hint.on) touch.failed = false;
  else sayTouch();
  askTouch();
}
function sayTouch() {
  const told = touch.collides === null ? "" : (touch.collides ? "collides" : "free") + (isSettled() ? "" : ", by estimate");
  element("touch").textContent = touch.failed ? "collisions are not told" : told;
}
