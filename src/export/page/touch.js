// Whether the robot that is moved by hand collides. Whoever serves the page knows it: at once an estimate, which goes on from the last exact
// answer, and soon after the exact answer. A page that is a file has nobody to ask.
const touch = { known: false, collides: false, exact: false, at: "", asking: false };
const TOUCH_PAUSE = 20;
const handText = () => hint.now.config.join(",");
// One question at a time, until the exact answer for the place where the robot stands is there.
async function askTouch() {
  if (!data.live || !hint.on || touch.asking || touch.exact && touch.at === handText()) return;
  touch.asking = true;
  try {
    do {
      const at = handText(), answer = await fetch("collides?q=" + at, { cache: "no-store" });
      if (!answer.ok) throw new Error();
      const { collides, exact } = await answer.json();
      Object.assign(touch, { known: true, collides, exact, at });
      sayTouch();
      repaint();
      if (!exact) await new Promise((goOn) => setTimeout(goOn, TOUCH_PAUSE));
    } while (hint.on && !(touch.exact && touch.at === handText()));
  } catch {
    touch.known = false;
  }
  touch.asking = false;
}
const handColour = () => touch.known && touch.collides ? [0.86, 0.16, 0.14] : AMBER;
function tellTouch() {
  sayTouch();
  askTouch();
}
function sayTouch() {
  element("touch").textContent = !touch.known ? "" : (touch.collides ? "collides" : "free") + (touch.exact ? "" : ", by estimate");
}
