// A picture seen from far away that is turned by dragging and with the arrow keys.

import { el } from "../dom.js";
import { viewOn } from "./projection.js";

const KEY_STEP = 5;
const ZOOM_STEP = 1.25;
const MOST_ZOOM = 12;
/** Below this way a press is no drag of what it is on, px. */
const SLACK = 4;

/** Where one looks from, degrees, and how closely; `renew` is called after every change. */
export class Pose {
  longitude = 0;
  latitude = 0;
  zoom = 1;
  #renew;

  constructor(renew) {
    this.#renew = renew;
  }

  get view() {
    return viewOn(this.longitude, this.latitude);
  }

  /** Looks at a place. */
  look(longitude, latitude) {
    this.longitude = (longitude + 360) % 360;
    this.latitude = Math.max(-90, Math.min(90, latitude));
    this.#renew();
  }

  turn(longitude, latitude) {
    this.look(this.longitude + longitude, this.latitude + latitude);
  }

  enlarge(factor) {
    this.zoom = Math.max(1, Math.min(MOST_ZOOM, this.zoom * factor));
    this.#renew();
  }

  /** Longitude, latitude and zoom as a text. */
  told() {
    return `${this.longitude.toFixed(1)} ${this.latitude.toFixed(1)} ${this.zoom.toFixed(2)}`;
  }
}

/**
 * Makes a picture turn: `draw` draws it again, at most once a frame, `home` tells the longitude and
 * latitude that it begins with. `width` tells how wide the unit sphere is drawn without zoom, px. `grab` is
 * called with a pointer that goes down, and may return what takes its moves instead: {move, end}. `more` has
 * acts for further keys, "Shift+" before those with it.
 */
export function turning(picture, { draw, home, width, grab = () => null, more = {} }) {
  let asked = false;
  const renew = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw();
    });
  };
  const pose = new Pose(renew);
  const reset = () => {
    pose.zoom = 1;
    pose.look(...home());
  };
  const dragged = (dx, dy) => {
    const degrees = 360 / (Math.PI * width() * pose.zoom);
    pose.turn(-dx * degrees, dy * degrees);
  };
  listenToKeys(picture, {
    ArrowLeft: () => pose.turn(-KEY_STEP, 0), ArrowRight: () => pose.turn(KEY_STEP, 0),
    ArrowUp: () => pose.turn(0, KEY_STEP), ArrowDown: () => pose.turn(0, -KEY_STEP),
    "+": () => pose.enlarge(ZOOM_STEP), "=": () => pose.enlarge(ZOOM_STEP), "-": () => pose.enlarge(1 / ZOOM_STEP), 0: reset, ...more,
  });
  listenToPointer(picture, grab, dragged);
  const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  return {
    pose,
    renew,
    reset,
    buttons: [
      button("−", "Zoom out", () => pose.enlarge(1 / ZOOM_STEP)), button("+", "Zoom in", () => pose.enlarge(ZOOM_STEP)),
      button("Reset", "Reset the view", reset),
    ],
  };
}

function listenToKeys(picture, acts) {
  picture.addEventListener("keydown", (event) => {
    picture.classList.remove("pointed");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const act = (event.shiftKey && acts[`Shift+${event.key}`]) || acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function listenToPointer(picture, grab, dragged) {
  let press = null;
  const place = (event) => {
    const box = picture.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  picture.addEventListener("pointerdown", (event) => {
    if (press) return;
    // Whoever points sees what is turned; the frame of the focus is for keys.
    picture.classList.add("pointed");
    press = { id: event.pointerId, from: event, begun: event, held: grab(event), isDrag: false, asked: false };
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!press || event.pointerId !== press.id) return;
    if (press.held) hold(press, event, place);
    else dragged(event.clientX - press.from.clientX, event.clientY - press.from.clientY);
    press.from = event;
  });
  picture.addEventListener("focus", () => {
    if (!press) picture.classList.remove("pointed");
  });
  const end = (event) => {
    if (!press || event.pointerId !== press.id) return;
    const { held, begun, from, asked, next } = press;
    if (held && asked) held.move(next);
    // The browser takes the finger for a scroll: what it has turned until then is taken back.
    if (!held && event.type === "pointercancel") dragged(begun.clientX - from.clientX, begun.clientY - from.clientY);
    press.asked = false;
    press = null;
    held?.end();
  };
  for (const kind of ["pointerup", "pointercancel"]) picture.addEventListener(kind, end);
}

/** What is held goes along with the pointer, once a frame. */
function hold(press, event, place) {
  press.isDrag ||= Math.hypot(event.clientX - press.begun.clientX, event.clientY - press.begun.clientY) > SLACK;
  if (!press.isDrag) return;
  press.next = place(event);
  if (press.asked) return;
  press.asked = true;
  requestAnimationFrame(() => {
    if (press.asked) press.held.move(press.next);
    press.asked = false;
  });
}
