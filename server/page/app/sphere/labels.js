// Places for names beside points, so that they cover neither each other nor the points.

/** Distances of a name from its point, in its own heights, and directions that are tried at each. */
const STEPS = [0, 0.6, 1.3, 2.1, 3, 4, 5.2, 6.5, 8, 10, 12, 14];
const TURNS = [0, 8, 4, 12, 1, 15, 7, 9, 3, 13, 5, 11, 2, 14, 6, 10];

const overlap = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/**
 * Boxes {x, y, width, height} for names of points {x, y, width, height, radius} in a square of a size,
 * null for a name that has no place. The first points get the nearest places.
 */
export function placeLabels(points, size) {
  const marks = points.map(({ x, y, radius }) => ({ x: x - radius, y: y - radius, width: 2 * radius, height: 2 * radius }));
  const taken = [];
  return points.map((point, index) => {
    for (const covering of [false, true]) {
      for (const step of STEPS) {
        for (const turn of TURNS) {
          const box = boxAt(point, point.radius + 2 + step * point.height, (turn * Math.PI) / 8);
          const isInside = box.x >= 0 && box.y >= 0 && box.x + box.width <= size && box.y + box.height <= size;
          // Where all is full a name rather covers another point than none is shown.
          const others = covering ? [marks[index]] : marks;
          if (isInside && ![...others, ...taken].some((other) => overlap(box, other))) {
            taken.push(box);
            return box;
          }
        }
      }
    }
    return null;
  });
}

/** The box of a name whose nearest edge is so far from its point, in a direction. */
function boxAt({ x, y, width, height }, distance, turn) {
  const [right, up] = [Math.cos(turn), Math.sin(turn)];
  const [cx, cy] = [x + right * (distance + width / 2), y - up * (distance + height / 2)];
  return { x: cx - width / 2, y: cy - height / 2, width, height };
}
