// Keys and pointers on the sky before planning.

const TURN_STEP = 5;
/** Below this way a press is no drag, px. */
const SLACK = 4;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Arrows turn, or with Shift move the chosen target; n and p choose; plus, minus and 0 are the view. */
export function listenToSkyKeys(picture, { turning, reset, step, shift, zoomStep }) {
  const acts = {
    "+": () => turning.enlarge(zoomStep), "=": () => turning.enlarge(zoomStep), "-": () => turning.enlarge(1 / zoomStep),
    0: reset, n: () => step(1), p: () => step(-1),
  };
  picture.addEventListener("keydown", (event) => {
    picture.classList.remove("pointed");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    const act = arrow
      ? () => (event.shiftKey ? shift(...arrow) : turning.turn(arrow[0] * TURN_STEP, arrow[1] * TURN_STEP))
      : acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

/**
 * A drag of the background turns the sphere, one of a target moves it. A finger chooses a target with a
 * first touch and moves it with the next, so that a page can be scrolled over the sky.
 */
export function listenToSkyPointer(picture, { choose, isChosen, drag, turnBy, settle }) {
  let press = null;
  const place = (event) => {
    const box = picture.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  picture.addEventListener("pointerdown", (event) => {
    if (press) return;
    // Whoever points sees what is turned; the frame of the focus is for keys.
    picture.classList.add("pointed");
    const hit = event.target.closest?.(".place.target:not(.behind)");
    const index = hit ? Number(hit.dataset.index) : null;
    const mayDrag = index !== null && (event.pointerType === "mouse" || isChosen(index));
    press = { id: event.pointerId, from: event, begun: event, index: mayDrag ? index : null, isDrag: false };
    if (index !== null) choose(index);
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!press || event.pointerId !== press.id) return;
    press.isDrag ||= Math.hypot(event.clientX - press.begun.clientX, event.clientY - press.begun.clientY) > SLACK;
    if (!press.isDrag) return;
    if (press.index !== null) press.next = place(event);
    else turnBy(event.clientX - press.from.clientX, event.clientY - press.from.clientY);
    press.from = event;
    if (press.index !== null && !press.asked) {
      press.asked = true;
      const now = press;
      requestAnimationFrame(() => {
        now.asked = false;
        drag(now.next, now.index);
      });
    }
  });
  picture.addEventListener("focus", () => {
    if (!press) picture.classList.remove("pointed");
  });
  const end = (event) => {
    if (!press || event.pointerId !== press.id) return;
    if (press.asked) drag(press.next, press.index);
    press = null;
    settle();
  };
  picture.addEventListener("pointerup", end);
  picture.addEventListener("pointercancel", (event) => {
    if (!press || event.pointerId !== press.id) return;
    // The browser takes the finger for a scroll: what it has turned until then is taken back.
    if (press.index === null && press.isDrag) turnBy(press.begun.clientX - press.from.clientX, press.begun.clientY - press.from.clientY);
    press = null;
    settle();
  });
}
