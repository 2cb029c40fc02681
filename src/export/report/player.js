"use strict";
// Plays frames by the button `play` and the slider `frame`, to and fro: every `pause` milliseconds the slider goes on by
// `stride()`, and `show` draws the frame where the slider is. `stop` ends playing; `begin` goes to the first of so many frames.
const player = (show, pause, stride = () => 1) => {
  const [button, slider] = ["play", "frame"].map((id) => document.getElementById(id));
  let [timer, direction] = [null, 1];
  const stop = () => {
    clearInterval(timer);
    timer = null;
    button.textContent = "play";
  };
  const step = () => {
    const [frame, last, by] = [Number(slider.value), Number(slider.max), stride()];
    if (frame >= last) direction = -1;
    if (frame <= 0) direction = 1;
    slider.value = Math.min(last, Math.max(0, frame + direction * by));
    show();
  };
  const toggle = () => {
    if (timer !== null) return stop();
    timer = setInterval(step, pause);
    button.textContent = "pause";
  };
  const begin = (frames) => {
    stop();
    direction = 1;
    slider.max = Math.max(0, frames - 1);
    slider.value = 0;
  };
  button.onclick = toggle;
  slider.oninput = () => {
    stop();
    show();
  };
  return { stop, begin, toggle };
};
