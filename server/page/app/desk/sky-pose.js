// A sphere that is turned, enlarged and shown again.

import { viewOn } from "../sphere/projection.js";

const MAX_ZOOM = 12;

/** Where one looks from. `draw` is called with {view, zoom} at most once a frame. */
export class SkyPose {
  #draw;
  #asked = false;
  longitude = 0;
  latitude = 0;
  zoom = 1;

  constructor(draw) {
    this.#draw = draw;
  }

  get view() {
    return viewOn(this.longitude, this.latitude);
  }

  /** Looks at a place, degrees. */
  look(longitude, latitude) {
    this.longitude = (longitude + 360) % 360;
    this.latitude = Math.max(-90, Math.min(90, latitude));
    this.renew();
  }

  turn(longitude, latitude) {
    this.look(this.longitude + longitude, this.latitude + latitude);
  }

  enlarge(factor) {
    this.zoom = Math.max(1, Math.min(MAX_ZOOM, this.zoom * factor));
    this.renew();
  }

  /** Draws with the next frame. */
  renew() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#draw();
    });
  }
}
