// How canvases are drawn again, as lines and letters.

const painters = new WeakMap();

/** `paint` is called with a context whose origin is the corner of the canvas, in px of the page. */
export const paintAgain = (canvas, paint) => painters.set(canvas, paint);

export const painterOf = (canvas) => painters.get(canvas);
