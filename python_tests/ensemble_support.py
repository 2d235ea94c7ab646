"""Slopes whose factor of safety is a formula, for the tests of ensembles and their workers."""

import math

import enmm

FRICTION = "joint_law.joint.friction_deg"
PLANE_FRICTION, PLANE_COHESION = "joint_law.plane.friction_deg", "joint_law.plane.cohesion"
BLOCK = math.radians(30)
"""Dip of the plane below the block (rad)."""
HEIGHT, CRACK, FACE, PLANE, WEIGHT = 60.0, 14.0, math.radians(50), math.radians(35), 26.5e3
"""Plane slide: height and depth of the crack (m), dips of face and plane (rad), unit weight (N/m3)."""


def place(along, above):
    """A point of the incline (m), from its distances along the plane and above it."""
    s, c = math.sin(BLOCK), math.cos(BLOCK)
    return [along * c + above * s, above * c - along * s]


def block(wall=0.0, duration=1.0):
    """A block of 1 m on an incline of 30 degrees: F = tan(friction)/tan 30. With a `wall` so far (m) in front of it.

    The static stage is short, so that a block that is too weak does not slide off before its strength is reduced.
    """
    end = [(1 + wall, 0), (1 + wall, 0.5), (2, 0.5), (2, -0.8)] if wall else [(1, -0.8)]
    outline = [(-1, -0.8), *end[::-1], (1, 0), (1, 1), (0, 1), (0, 0), (-1, 0)]
    return enmm.Case.from_dict(
        {
            "title": "A block on an incline",
            "domain": {"outline": [place(*point) for point in outline]},
            "mesh": {"size": 0.6, "origin": [0.031, 0.017]},
            "joint": [{"points": [place(0, 0), place(1, 0)]}],
            "rock": {"rock": {"density": 2650.0, "young": 10e9, "poisson": 0.25}},
            "joint_law": {"joint": {"friction_deg": 35.0}},
            "fix": [{"block": place(-0.5, -0.4)}],
            "stage": [{"name": "settle", "kind": "static", "duration": duration, "convergence": 1e-6}],
        }
    )


def plane_slide():
    """A dry wedge on a plane, its head at the foot of a tension crack; the face goes on below the toe."""
    face, plane = math.tan(FACE), math.tan(PLANE)
    head = HEIGHT - CRACK
    x, low = head / plane, -0.25 * HEIGHT
    right = x + 0.3 * HEIGHT
    crest = [[right, HEIGHT], [x, HEIGHT], [HEIGHT / face, HEIGHT]]
    return enmm.Case.from_dict(
        {
            "title": "A plane slide",
            "domain": {"outline": [[low / face, low], [right, low], *crest], "joint_law": "plane"},
            "mesh": {"size": 0.13 * HEIGHT, "origin": [0.31, 0.17]},
            "joint": [
                {"points": [[0.0, 0.0], [x, head]]},
                {"points": [[x, head], [x, HEIGHT]], "law": "crack"},
            ],
            "rock": {"rock": {"density": WEIGHT / 9.81, "young": 5e10, "poisson": 0.25}},
            "joint_law": {"plane": {"friction_deg": 30.0, "cohesion": 60e3}, "crack": {"friction_deg": 0.0}},
            "fix": [{"block": [0.5 * right, 0.5 * low]}],
            "stage": [{"name": "settle", "kind": "static", "duration": 3.0, "convergence": 1e-5}],
        }
    )


def plane_slide_factor(cohesion, tangent):
    """Its factor of safety, (cA + W cos(dip) tan(friction))/(W sin(dip)) (E. Hoek and J. W. Bray)."""
    length = (HEIGHT - CRACK) / math.sin(PLANE)
    share = 1.0 - (CRACK / HEIGHT) ** 2
    weight = 0.5 * WEIGHT * HEIGHT**2 * (share / math.tan(PLANE) - 1.0 / math.tan(FACE))
    return (cohesion * length + weight * math.cos(PLANE) * tangent) / (weight * math.sin(PLANE))
