// A picture seen from far away that is turned by dragging and with the arrow keys.

import { el } from "../dom.js";

const KEY_STEP = 5;
const ZOOM_STEP = 1.25;
const MOST_ZOOM = 12;

/**
 * Makes a picture turn: `renew` draws it again, `home` tells the longitude and latitude that it begins
 * with, degrees. `width` tells how wide the unit sphere is drawn without zoom, px; `pressed` is called
 * with what a pointer goes down on, `more` has acts for further keys.
 */
export function turning(picture, { renew, home, width, pressed = () => {}, more = {} }) {
  const pose = { longitude: 0, latitude: 0, zoom: 1 };
  const turn = (longitude, latitude) => {
    pose.longitude = (pose.longitude + longitude + 360) % 360;
    pose.latitude = Math.max(-90, Math.min(90, pose.latitude + latitude));
    renew();
  };
  const zoom = (factor) => {
    pose.zoom = Math.max(1, Math.min(MOST_ZOOM, pose.zoom * factor));
    renew();
  };
  const reset = () => {
    [pose.longitude, pose.latitude] = home();
    pose.zoom = 1;
    renew();
  };
  const dragged = (dx, dy) => {
    const degrees = 360 / (Math.PI * width() * pose.zoom);
    turn(-dx * degrees, dy * degrees);
  };
  listenToKeys(picture, {
    ArrowLeft: () => turn(-KEY_STEP, 0), ArrowRight: () => turn(KEY_STEP, 0),
    ArrowUp: () => turn(0, KEY_STEP), ArrowDown: () => turn(0, -KEY_STEP),
    "+": () => zoom(ZOOM_STEP), "=": () => zoom(ZOOM_STEP), "-": () => zoom(1 / ZOOM_STEP), 0: reset, ...more,
  });
  listenToPointer(picture, pressed, dragged);
  const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  return {
    pose,
    reset,
    buttons: [
      button("−", "Zoom out", () => zoom(1 / ZOOM_STEP)), button("+", "Zoom in", () => zoom(ZOOM_STEP)),
      button("Reset", "Reset the view", reset),
    ],
    /** Longitude, latitude and zoom as a text. */
    told: () => `${pose.longitude.toFixed(1)} ${pose.latitude.toFixed(1)} ${pose.zoom.toFixed(2)}`,
  };
}

function listenToKeys(picture, acts) {
  picture.addEventListener("keydown", (event) => {
    picture.classList.remove("pointed");
    const act = !event.ctrlKey && !event.metaKey && !event.altKey && acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function listenToPointer(picture, pressed, dragged) {
  let [from, begun] = [null, null];
  picture.addEventListener("pointerdown", (event) => {
    from = begun = event;
    // Whoever points sees what is turned; the frame of the focus is for keys.
    picture.classList.add("pointed");
    pressed(event.target);
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!from || event.pointerId !== from.pointerId) return;
    dragged(event.clientX - from.clientX, event.clientY - from.clientY);
    from = event;
  });
  picture.addEventListener("focus", () => {
    if (!from) picture.classList.remove("pointed");
  });
  picture.addEventListener("pointerup", () => (from = null));
  // The browser takes the finger for a scroll: what it has turned until then is taken back.
  picture.addEventListener("pointercancel", () => {
    if (from) dragged(begun.clientX - from.clientX, begun.clientY - from.clientY);
    from = null;
  });
}
