"use strict";
// The animal's skin and the forces on it. The skin is what self-contact knows: the sphere that sweeps along the uniform
// Catmull-Rom spline through the body centres, with a radius linear in its parameter.

const SIDES = 24, RINGS_PER_SEGMENT = 2, CAP_RINGS = 5;
const FORCE_LENGTH = 5; // cm of the arrow of the largest force of a kind
const ARROWS = { contact: 0xd55e00, head: 0x0072b2, tip: 0x7f7f7f, hand: 0xcc79a7 };
const ARROW_WORDS = { contact: "contacts, step at the frame", head: "what clamps the head", tip: "script's pull on the tail", hand: "your pull" };

/** A point of the spline: of `centres` at `offset`, three numbers a body, into `out`. */
function splinePoint(centres, offset, bodies, segment, t, out) {
  const t2 = t * t, t3 = t2 * t;
  const w = [0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3), 0.5 * (t + 4 * t2 - 3 * t3), 0.5 * (t3 - t2)];
  for (let i = 0; i < 3; ++i) {
    const at = (b) => centres[offset + 3 * b + i];
    const before = segment > 0 ? at(segment - 1) : 2 * at(0) - at(1);
    const after = segment + 2 < bodies ? at(segment + 2) : 2 * at(bodies - 1) - at(bodies - 2);
    out[i] = w[0] * before + w[1] * at(segment) + w[2] * at(segment + 1) + w[3] * after;
  }
}

/** A square of a plane (view/drawn_obstacles.hpp), seen from before it alone: a plate with a hole, or a floor. */
function planeMesh({ point, normal, half, hole }) {
  const square = new THREE.Shape(), material = new THREE.MeshPhongMaterial({ color: 0xb8c2cc });
  [[-half, -half], [half, -half], [half, half], [-half, half]].forEach(([x, y], k) => (k ? square.lineTo(x, y) : square.moveTo(x, y)));
  if (hole > 0) square.holes.push(new THREE.Path().absarc(0, 0, hole, 0, 2 * Math.PI, true));
  const out = new THREE.Vector3(...normal), mesh = new THREE.Mesh(new THREE.ExtrudeGeometry(square, { depth: 0.3, bevelEnabled: false, curveSegments: 48 }), material);
  // Turned about the upright as little as may be: X of the square lies level.
  const level = new THREE.Vector3(-out.y, out.x, 0);
  if (level.lengthSq() < 1e-6) level.set(1, 0, 0);
  level.normalize();
  mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(level, new THREE.Vector3().crossVectors(out, level), out));
  mesh.position.set(...point).addScaledVector(out, -0.3);
  return mesh;
}

/** An obstacle: a square of a plane, or the tube about the curve through its points, with round ends. What is in a ring is seen through it. */
function obstacleMesh(obstacle) {
  const group = new THREE.Group();
  if (obstacle.normal) {
    group.add(planeMesh(obstacle));
    return group;
  }
  const points = obstacle.points.map((p) => new THREE.Vector3(...p)), { radius, closed, ring } = obstacle;
  const material = new THREE.MeshPhongMaterial(ring ? { color: 0x9ab0ca, transparent: true, opacity: 0.3, depthWrite: false } : { color: 0x6b7a8f });
  const add = (geometry, at) => { const mesh = new THREE.Mesh(geometry, material); if (at) mesh.position.copy(at); group.add(mesh); };
  if (points.length > 1) {
    const curve = new THREE.CatmullRomCurve3(points, closed, "catmullrom", 0.5); // the uniform one
    add(new THREE.TubeGeometry(curve, 8 * points.length, radius, 20, closed));
  }
  if (!closed) for (const end of [points[0], points[points.length - 1]]) add(new THREE.SphereGeometry(radius, 20, 14), end);
  return group;
}

class Body {
  /** `ghost`: pale and without colours, to lie over another. */
  constructor(log, ghost) {
    this.log = log;
    this.group = new THREE.Group();
    const along = (log.bodies - 1) * RINGS_PER_SEGMENT + 1;
    this.rings = along + 2 * CAP_RINGS;
    const { arc, radius } = log.animal;
    // For each ring the place on the spline, the radius, how far it lies before or behind, and its arc.
    this.ring = [];
    const last = log.bodies - 1;
    for (let k = 0; k < this.rings; ++k) {
      const place = Math.min(Math.max(k - CAP_RINGS, 0), along - 1);
      const segment = Math.min(Math.floor(place / RINGS_PER_SEGMENT), last - 1);
      const t = place / RINGS_PER_SEGMENT - segment;
      const own = radius[segment] * (1 - t) + radius[segment + 1] * t;
      const turn = (k < CAP_RINGS ? -(CAP_RINGS - k) : k - CAP_RINGS >= along ? k - CAP_RINGS - along + 1 : 0) * Math.PI / 2 / CAP_RINGS;
      this.ring.push({ segment, t, radius: own * Math.cos(turn), ahead: own * Math.sin(turn), tilt: Math.sin(turn), arc: arc[segment] * (1 - t) + arc[segment + 1] * t });
    }
    const vertices = this.rings * SIDES, index = [];
    for (let k = 0; k + 1 < this.rings; ++k) {
      for (let s = 0; s < SIDES; ++s) {
        const a = k * SIDES + s, b = k * SIDES + (s + 1) % SIDES;
        index.push(a, b, a + SIDES, b, b + SIDES, a + SIDES);
      }
    }
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(index);
    for (const name of ["position", "normal", "color"]) this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    this.material = new THREE.MeshPhongMaterial({ vertexColors: THREE.VertexColors, shininess: 25, specular: 0x333333, side: THREE.DoubleSide, transparent: ghost, opacity: ghost ? 0.45 : 1 });
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
    this.group.add(this.mesh);
    this.arrows = new THREE.Group();
    this.group.add(this.arrows);
    this.plate = new THREE.Mesh(new THREE.BoxGeometry(0.3, 5.2, 5.2), new THREE.MeshPhongMaterial({ color: 0xb8c2cc, transparent: true }));
    this.plate.position.x = -0.15;
    this.plate.visible = log.plate;
    this.group.add(this.plate);
    this.obstacles = log.obstacles.map((obstacle) => obstacleMesh(obstacle));
    this.obstacles.forEach((mesh) => this.group.add(mesh));
    this.largest = { contact: 1e-9, head: 1e-9, tip: 1e-9, hand: 1e-9 };
    this.measured = 0;
    this.measure();
  }

  /** Takes note of the largest forces of the frames that have come since: arrows are drawn to them. */
  measure() {
    const { log } = this, { first, values } = log.contacts;
    for (let c = first[this.measured]; c < first[log.frames]; ++c) this.largest.contact = Math.max(this.largest.contact, values[9 * c + 6]);
    for (; this.measured < log.frames; ++this.measured) {
      for (const [kind, forces, width] of [["head", log.head, 6], ["tip", log.tip, 3], ["hand", log.hand, 3]]) {
        const f = this.measured * width, size = forces ? Math.hypot(forces[f], forces[f + 1], forces[f + 2]) : 0;
        if (size > this.largest[kind]) this.largest[kind] = size;
      }
    }
  }

  /** Puts the skin where the body is in a frame. */
  pose(frame) {
    const { log } = this, offset = 3 * log.bodies * frame;
    const position = this.geometry.attributes.position.array, normal = this.geometry.attributes.normal.array;
    const point = [0, 0, 0], beside = [0, 0, 0];
    const along = new THREE.Vector3(), across = new THREE.Vector3(0, 0, 1), third = new THREE.Vector3();
    const EPSILON = 1e-3;
    this.ring.forEach((ring, k) => {
      splinePoint(log.position, offset, log.bodies, ring.segment, ring.t, point);
      splinePoint(log.position, offset, log.bodies, ring.segment, ring.t + (ring.t > 0.5 ? -EPSILON : EPSILON), beside);
      const sign = ring.t > 0.5 ? -1 : 1;
      along.set(sign * (beside[0] - point[0]), sign * (beside[1] - point[1]), sign * (beside[2] - point[2])).normalize();
      // Carried along without turning about the body.
      across.addScaledVector(along, -across.dot(along));
      if (across.lengthSq() < 1e-6) across.set(along.y, -along.x, 0.1).addScaledVector(along, -across.dot(along));
      across.normalize();
      third.crossVectors(along, across);
      const flat = Math.sqrt(1 - ring.tilt * ring.tilt);
      for (let s = 0; s < SIDES; ++s) {
        const c = Math.cos(2 * Math.PI * s / SIDES), d = Math.sin(2 * Math.PI * s / SIDES), v = 3 * (k * SIDES + s);
        ["x", "y", "z"].forEach((axis, i) => {
          const out = c * across[axis] + d * third[axis];
          position[v + i] = point[i] + ring.radius * out + ring.ahead * along[axis];
          normal[v + i] = flat * out + ring.tilt * along[axis];
        });
      }
    });
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.attributes.normal.needsUpdate = true;
    this.plate.material.opacity = log.clamped[frame] ? 0.9 : 0.35;
  }

  /** Colours the skin by a field of the log, or plainly. Dark rings are the stations where the animal was measured. */
  paint(frame, field, scale) {
    const colour = this.geometry.attributes.color.array, { station, length } = this.log.animal;
    this.ring.forEach((ring, k) => {
      let own = [0.72, 0.6, 0.56];
      if (field) {
        const n = field.arc.length, next = d3.bisectLeft(field.arc, ring.arc), a = Math.max(next - 1, 0), b = Math.min(next, n - 1);
        const share = a === b ? 0 : (ring.arc - field.arc[a]) / (field.arc[b] - field.arc[a]);
        own = colourOf((1 - share) * field.values[frame * n + a] + share * field.values[frame * n + b], scale);
      }
      const mark = station.some((s) => Math.abs(ring.arc - s * length) < 0.13) ? 0.45 : 1;
      for (let s = 0; s < SIDES; ++s) for (let i = 0; i < 3; ++i) colour[3 * (k * SIDES + s) + i] = mark * own[i];
    });
    this.geometry.attributes.color.needsUpdate = true;
  }

  addArrow(place, direction, force, largest, colour) {
    const size = direction.length();
    if (!(size > 0) || !(force > 0)) return;
    const long = Math.max(0.4, FORCE_LENGTH * force / largest);
    const arrow = new THREE.ArrowHelper(direction.divideScalar(size), place, long, colour, Math.min(0.5 * long, 0.7), 0.28);
    // Contacts lie between skins: seen through them.
    for (const part of [arrow.line, arrow.cone]) {
      part.material.depthTest = false;
      part.renderOrder = 1;
    }
    this.arrows.add(arrow);
  }

  /** Arrows of a frame: contacts both ways, what clamps the head, the script's pull on the tail. */
  drawForces(frame, shown) {
    for (const arrow of this.arrows.children.slice()) {
      this.arrows.remove(arrow);
      arrow.line.material.dispose();
      arrow.cone.material.dispose();
    }
    if (!shown) return;
    const { log, largest } = this, { first, values } = log.contacts;
    const vector = (from, at) => new THREE.Vector3(from[at], from[at + 1], from[at + 2]);
    for (let c = 9 * first[frame]; c < 9 * first[frame + 1]; c += 9) {
      const place = vector(values, c), push = vector(values, c + 3), force = values[c + 6];
      this.addArrow(place, push.clone(), force, largest.contact, ARROWS.contact);
      if (!Number.isNaN(values[c + 8])) this.addArrow(place, push.negate(), force, largest.contact, ARROWS.contact);
    }
    const offset = 3 * log.bodies * frame;
    const head = vector(log.head, 6 * frame), tip = vector(log.tip, 3 * frame);
    this.addArrow(vector(log.position, offset), head, head.length(), largest.head, ARROWS.head);
    this.addArrow(vector(log.position, offset + 3 * (log.bodies - 1)), tip, tip.length(), largest.tip, ARROWS.tip);
    if (!log.hand) return;
    const hand = vector(log.hand, 3 * frame);
    this.addArrow(vector(log.position, offset + 3 * log.held[frame]), hand, hand.length(), largest.hand, ARROWS.hand);
  }
}
