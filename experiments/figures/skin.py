"""The animal's smooth skin from one logged frame, and a small z-buffer renderer for it.

The skin is a tube along the Catmull-Rom spline through the body centres, with the measured radii.
It is drawn as closely spaced spheres: every pixel then knows its exact depth, the sample of the
spline it shows and the direction it faces, from which it is shaded.

Drawing only: the caps that close the two ends, the colours, and the way the back is turned at rest
are no data. Turns of the skin along the body are data: they follow the logged joint angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hagfish_log import HagfishLog

SPACING = 0.03  # between spline samples, cm; 1/60 of the body's width, so no sphere is seen
STATIONS = (0.2, 0.4, 0.6, 0.8)  # where the specimen was measured, fraction of length
BACK, BELLY, RING = np.array([[0.53, 0.395, 0.395], [0.92, 0.75, 0.70], [0.30, 0.20, 0.21]])
PLATE_CLAMPED, PLATE_FREE = np.array([[0.72, 0.76, 0.80], [0.91, 0.93, 0.95]])
LIGHT = np.array([-0.25, 0.55, 0.80]) / np.linalg.norm([-0.25, 0.55, 0.80])  # camera axes, towards it


@dataclass
class Skin:
    """Samples along the spline, head to tail."""

    centre: np.ndarray  # n x 3, cm, world
    tangent: np.ndarray  # n x 3, towards the tail
    dorsal: np.ndarray  # n x 3, unit, where the back faces
    radius: np.ndarray  # n, cm
    arc: np.ndarray  # n, from the head, cm


@dataclass
class Camera:
    """Orthographic view."""

    right: np.ndarray
    up: np.ndarray
    toward: np.ndarray  # from the scene to the viewer

    def axes(self) -> np.ndarray:
        """World to camera (x right, y up, z towards the viewer)."""
        return np.stack([self.right, self.up, self.toward])


def camera(pitch: float, yaw: float) -> Camera:
    """View with +X to the right, turned about X by `pitch` and then about the picture's vertical by
    `yaw` (degrees); (0, 0) looks down -Z."""
    p, y = np.radians([pitch, yaw])
    up = np.array([0.0, np.cos(p), -np.sin(p)])
    front = np.array([0.0, np.sin(p), np.cos(p)])
    toward = np.array([np.sin(y), 0.0, 0.0]) + np.cos(y) * front
    return Camera(np.cross(up, toward), up, toward)


def _rotation(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def body_frames(log: HagfishLog, frame: int) -> np.ndarray:
    """Orientation of every body, body to world (N x 3 x 3), from the logged q."""
    q = log["/trajectory/q"][frame]
    w, x, y, z = q[3:7]
    orientation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    turns: dict[int, list[tuple[int, float]]] = {}
    for dof, joint, kind in zip(*log.hinges()):
        turns.setdefault(joint, []).append(({"twist": 0, "bend_y": 1, "bend_z": 2}[kind], q[dof + 1]))
    frames = [orientation]
    for body in range(1, len(log["/model/length"])):
        for axis, angle in turns.get(body, []):
            orientation = orientation @ _rotation(axis, angle)
        frames.append(orientation)
    return np.array(frames)


def make_skin(log: HagfishLog, frame: int, rest_back: np.ndarray) -> Skin:
    """The skin of one frame; `rest_back` is where the back faces on the straight animal (world)."""
    centre, length = log["/trajectory/position"][frame], log["/model/length"]
    knots = np.cumsum(length) - length / 2
    frames = body_frames(log, frame)
    # One point beyond each end, on the end body's axis, gives the spline its end tangents.
    padded = np.vstack([centre[0] - frames[0, :, 0] * length[0], centre,
                        centre[-1] + frames[-1, :, 0] * length[-1]])
    whole = knots[-1] + length[-1] / 2
    arc = np.linspace(0.0, whole, int(whole / SPACING) + 1)
    u = np.interp(arc, np.r_[-knots[0], knots, 2 * whole - knots[-1]], np.arange(len(padded)))
    k = np.clip(u.astype(int), 1, len(padded) - 3)
    t = (u - k)[:, None]
    p0, p1, p2, p3 = (padded[k + offset] for offset in (-1, 0, 1, 2))
    c1, c2, c3 = p2 - p0, 2 * p0 - 5 * p1 + 4 * p2 - p3, 3 * (p1 - p2) + p3 - p0
    point = p1 + 0.5 * t * (c1 + t * (c2 + t * c3))
    tangent = c1 + t * (2 * c2 + 3 * t * c3)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)

    back = frames @ (rest_back - rest_back[0] * np.array([1.0, 0.0, 0.0]))
    back = np.stack([np.interp(arc, knots, back[:, i]) for i in range(3)], axis=1)
    back -= np.sum(back * tangent, axis=1, keepdims=True) * tangent
    back /= np.linalg.norm(back, axis=1, keepdims=True)
    return Skin(point, tangent, back, _capped(np.interp(arc, knots, log["/model/radius"]), arc), arc)


def _capped(radius: np.ndarray, arc: np.ndarray) -> np.ndarray:
    """The radii with a blunt snout and a tapering tail; the ends keep to the animal's length."""
    def ramp(distance: np.ndarray, span: float, least: float) -> np.ndarray:
        x = np.clip(distance / span, 0.0, 1.0)
        return least + (1 - least) * np.sqrt(1 - (1 - x) ** 2)

    capped = radius * ramp(arc, 1.8, 0.45) * ramp(arc[-1] - arc, 3.5, 0.30)
    return np.minimum(capped, np.maximum(np.minimum(arc, arc[-1] - arc), 0.0) + 0.02)


def splat(points: np.ndarray, radius: np.ndarray, origin: np.ndarray, shape: tuple[int, int],
          scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Depth (-inf where empty) and nearest sphere (-1) of spheres in camera axes, on a grid of
    `shape` pixels, `scale` to the cm, whose first pixel's outer corner is at `origin` (x, y)."""
    depth, nearest = np.full(shape, -np.inf), np.full(shape, -1, dtype=np.int32)
    x = origin[0] + (np.arange(shape[1]) + 0.5) / scale
    y = origin[1] + (np.arange(shape[0]) + 0.5) / scale
    low = ((points[:, :2] - radius[:, None] - origin) * scale).astype(int)
    high = ((points[:, :2] + radius[:, None] - origin) * scale).astype(int) + 1
    low, high = np.maximum(low, 0), np.maximum(high, 0)
    for i, (px, py, pz) in enumerate(points):
        window = np.s_[low[i, 1]:high[i, 1], low[i, 0]:high[i, 0]]
        square = (radius[i] ** 2 - (x[window[1]] - px) ** 2)[None, :] - ((y[window[0]] - py) ** 2)[:, None]
        height = np.where(square > 0, pz + np.sqrt(np.maximum(square, 0)), -np.inf)
        nearer = height > depth[window]
        depth[window][nearer] = height[nearer]
        nearest[window][nearer] = i
    return depth, nearest


def exposure(skin: Skin, angles: int = 24, every: int = 5) -> np.ndarray:
    """Share of ambient light that reaches the skin (rings x angles from the back): what other
    strands hide, each taken as a string of spheres."""
    ring = slice(None, None, every)
    side = np.cross(skin.tangent[ring], skin.dorsal[ring])
    turn = np.linspace(0, 2 * np.pi, angles, endpoint=False)
    normal = (np.cos(turn)[None, :, None] * skin.dorsal[ring][:, None]
              + np.sin(turn)[None, :, None] * side[:, None])
    point = skin.centre[ring][:, None] + normal * skin.radius[ring][:, None, None]
    hidden = np.zeros(normal.shape[:2])
    step = max(1, int(0.4 / SPACING))
    for i in range(0, len(skin.arc), step):
        away = skin.centre[i] - point
        distance = np.maximum(np.linalg.norm(away, axis=2), skin.radius[i])
        facing = np.maximum(np.sum(away * normal, axis=2) / distance, 0.0)
        other = np.abs(skin.arc[ring] - skin.arc[i]) > 3.0  # the strand itself is convex enough
        hidden += other[:, None] * facing * (skin.radius[i] / distance) ** 2 * 0.4 / (2 * skin.radius[i])
    return np.exp(-1.1 * hidden)


def _shadow(point: np.ndarray, skin: Skin, view: Camera) -> np.ndarray:
    """Light that reaches points (camera axes) past the other strands, 0 to 1, with a soft edge."""
    side = np.cross([0.0, 1.0, 0.0], LIGHT)
    side /= np.linalg.norm(side)
    to_light = np.stack([side, np.cross(LIGHT, side), LIGHT])
    spheres = skin.centre @ view.axes().T @ to_light.T
    seen = point @ to_light.T
    origin, scale = spheres[:, :2].min(axis=0) - 1.5, 16.0
    shape = tuple(((spheres[:, :2].max(axis=0) + 1.5 - origin) * scale).astype(int)[::-1])
    depth, _ = splat(spheres, skin.radius, origin, shape, scale)
    lit = np.zeros(len(point))
    offsets = [(i, j) for i in range(-3, 4) for j in range(-3, 4) if i * i + j * j <= 9]
    for dx, dy in offsets:
        pixel = ((seen[:, :2] - origin) * scale).astype(int) + (dx, dy)
        pixel = np.clip(pixel, 0, np.array(shape[::-1]) - 1)
        lit += depth[pixel[:, 1], pixel[:, 0]] < seen[:, 2] + 0.35  # cm; a strand's own curve is less
    return lit / len(offsets)


def _skin_colour(arc: np.ndarray, whole: float, cosine: np.ndarray) -> np.ndarray:
    """Darker back, paler belly (`cosine` 1 on the back), a thin ring at each measured station."""
    blend = 1 / (1 + np.exp(-(cosine + 0.05) / 0.17))
    colour = BELLY + (BACK - BELLY) * blend[:, None]
    for station in STATIONS:
        ring = np.exp(-(((arc - station * whole) / 0.13) ** 4))
        colour += 0.75 * ring[:, None] * (RING - colour)
    return colour


def shade(skin: Skin, view: Camera, x: np.ndarray, y: np.ndarray, depth: np.ndarray,
          nearest: np.ndarray) -> np.ndarray:
    """Colour (n x 3) of the skin at pixels (x, y) in camera axes, with their depth and sample."""
    axes = view.axes()
    point = np.stack([x, y, depth], axis=1)
    offset = point - (skin.centre @ axes.T)[nearest]
    along = np.sum(offset * (skin.tangent @ axes.T)[nearest], axis=1)
    inner = (nearest > 0) & (nearest < len(skin.arc) - 1)
    normal = offset - np.where(inner, along, 0.0)[:, None] * (skin.tangent @ axes.T)[nearest]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    dorsal = (skin.dorsal @ axes.T)[nearest]
    side = np.cross((skin.tangent @ axes.T)[nearest], dorsal)
    cosine, sine = np.sum(normal * dorsal, axis=1), np.sum(normal * side, axis=1)

    open_sky = exposure(skin)
    turn = np.arctan2(sine, cosine) / (2 * np.pi) * open_sky.shape[1]
    low = np.floor(turn).astype(int)
    ring = nearest / 5
    ring0 = np.minimum(ring.astype(int), len(open_sky) - 1)
    ring1 = np.minimum(ring0 + 1, len(open_sky) - 1)
    a, b = turn - low, ring - ring0
    n = open_sky.shape[1]
    ambient = ((1 - b) * ((1 - a) * open_sky[ring0, low % n] + a * open_sky[ring0, (low + 1) % n])
               + b * ((1 - a) * open_sky[ring1, low % n] + a * open_sky[ring1, (low + 1) % n]))

    lit = _shadow(point + 0.05 * normal, skin, view)
    lambert = np.maximum((normal @ LIGHT + 0.25) / 1.25, 0.0)  # wrapped: skin scatters light
    half = LIGHT + (0, 0, 1)
    gloss = np.maximum(normal @ (half / np.linalg.norm(half)), 0.0)
    rim = (1 - np.clip(normal[:, 2], 0, 1)) ** 3
    fill = 0.5 + 0.5 * normal[:, 1]
    colour = _skin_colour(skin.arc[nearest], skin.arc[-1], cosine)
    light = ambient * (0.42 + 0.20 * fill) + 0.62 * lambert * (0.30 + 0.70 * lit)
    colour = colour * light[:, None] * np.array([1.0, 0.985, 0.97])
    colour += (lit * (0.10 * gloss**12 + 0.28 * gloss**70))[:, None]
    return colour * (1 - 0.50 * rim)[:, None]


def plate_faces(half_width: float, thickness: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """The head plate, a slab whose front is the plane x = 0: (corner and two edges, normal)."""
    w, t = half_width, thickness
    ex, ey, ez = np.eye(3)
    faces = [(np.array([[0, -w, -w], 2 * w * ey, 2 * w * ez]), ex)]
    for axis, other in ((ey, ez), (ez, ey)):
        for sign in (-1.0, 1.0):
            corner = sign * w * axis - w * other - t * ex
            faces.append((np.array([corner, 2 * w * other, t * ex]), sign * axis))
    return faces


def draw(skin: Skin, view: Camera, low: np.ndarray, size: np.ndarray, scale: float, clamped: bool,
         supersample: int = 2) -> np.ndarray:
    """Picture (rows from the bottom, RGB) of the window at `low` (cm in the picture plane) of
    `size` cm at `scale` pixels to the cm, head plate included."""
    fine = scale * supersample
    shape = tuple(np.round(size[::-1] * scale).astype(int) * supersample)
    axes = view.axes()
    depth, nearest = splat(skin.centre @ axes.T, skin.radius, low, shape, fine)
    x = low[0] + (np.arange(shape[1]) + 0.5) / fine
    y = low[1] + (np.arange(shape[0]) + 0.5) / fine
    picture = np.ones(shape + (3,))
    rows, columns = np.nonzero(nearest >= 0)
    picture[rows, columns] = shade(skin, view, x[columns], y[rows], depth[rows, columns],
                                   nearest[rows, columns])
    tone = PLATE_CLAMPED if clamped else PLATE_FREE
    for (corner, first, second), normal in plate_faces(half_width=2.6, thickness=0.5):
        if normal @ view.toward <= 1e-6:
            continue
        corner, first, second = (vector @ axes.T for vector in (corner, first, second))
        to_face = np.linalg.inv(np.array([first[:2], second[:2]]))
        dx, dy = x[None, :] - corner[0], y[:, None] - corner[1]
        u, v = (dx * to_face[0, i] + dy * to_face[1, i] for i in range(2))
        height = corner[2] + u * first[2] + v * second[2]
        shown = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1) & (height > depth)
        picture[shown] = tone * (0.72 + 0.28 * max(float(normal @ axes.T @ LIGHT), 0.0))
        depth[shown] = height[shown]
    blocks = picture.reshape(shape[0] // supersample, supersample, shape[1] // supersample, supersample, 3)
    return np.clip(blocks.mean(axis=(1, 3)), 0.0, 1.0)
