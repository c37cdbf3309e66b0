"""Clear ways between two attitudes: two trees over all rotations that grow towards each other.

For wheels that hold their momentum at rest in every attitude such a way is a slew, if a slow one; so
the search shows that a scenario can be solved. That it finds none shows nothing.
"""

import numpy as np

from cones import least, product, turn, unit

# Longest branch, and distance at which an edge is looked at, rad.
BRANCH, LOOK = 0.2, 0.01
MOST_NODES = 6000


def distance(one, other):
    """Angle of the rotation between attitudes, rad."""
    return 2 * np.arccos(np.clip(np.abs(np.asarray(one) @ other), 0.0, 1.0))


def along(start, goal, most=np.inf):
    """Attitudes at small steps of the turn from start towards goal, the last at most so far."""
    goal = goal if start @ goal >= 0 else -goal
    relative = product(start * [-1, -1, -1, 1], goal)
    angle = 2 * np.arctan2(np.linalg.norm(relative[:3]), relative[3])
    if angle < 1e-12:
        return start[None]
    axis, far = unit(relative[:3]), min(angle, most)
    return np.array([
        product(start, turn(axis * part)) for part in np.linspace(0, far, int(np.ceil(far / LOOK)) + 1)
    ])


class Tree:
    def __init__(self, root):
        self.nodes, self.parents = [root], [None]

    def nearest(self, place):
        return int(np.argmax(np.abs(np.array(self.nodes) @ place)))

    def grow(self, place, clear):
        """A branch towards a place; its node, or none where it would not be clear."""
        parent = self.nearest(place)
        edge = along(self.nodes[parent], place, BRANCH)
        if not clear(edge):
            return None
        self.nodes.append(edge[-1])
        self.parents.append(parent)
        return edge[-1]

    def way(self, index=-1):
        """Nodes from the root to a node."""
        index, found = range(len(self.nodes))[index], []
        while index is not None:
            found.append(self.nodes[index])
            index = self.parents[index]
        return found[::-1]


def detour(limits, start, goal, generator, margin=0.0):
    """Attitudes of a way with this clearance, rad, or none where the search ends without."""

    def clear(attitudes):
        return least(limits, attitudes) >= margin

    trees, forward = [Tree(start), Tree(goal)], True
    while sum(len(tree.nodes) for tree in trees) < MOST_NODES:
        grown = trees[0].grow(unit(generator.normal(size=4)), clear)
        while grown is not None:
            reached = trees[1].grow(grown, clear)
            if reached is None:
                break
            if distance(reached, grown) < 1e-7:
                ways = [tree.way() for tree in trees]
                first, second = ways if forward else ways[::-1]
                return shortened(first + second[::-1], clear, generator)
        trees, forward = trees[::-1], not forward
    return None


def shortened(nodes, clear, generator, tries=200):
    """The same way with short cuts, as dense attitudes."""
    for _ in range(tries):
        if len(nodes) < 3:
            break
        first, last = sorted(generator.choice(len(nodes), 2, replace=False))
        if last - first > 1 and clear(along(nodes[first], nodes[last])):
            nodes = nodes[: first + 1] + nodes[last:]
    return np.concatenate([along(one, other) for one, other in zip(nodes, nodes[1:])])


def length(way):
    """Total turn of dense attitudes, rad."""
    # The chord is exact where the arc cosine of small angles is not.
    signs = np.sign(np.sum(way[1:] * way[:-1], axis=1))[:, None]
    return float(np.sum(4 * np.arcsin(np.linalg.norm(way[1:] * signs - way[:-1], axis=1) / 2)))
