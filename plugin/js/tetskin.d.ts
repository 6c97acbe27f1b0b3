// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// tetskin for JavaScript: soft bodies of Bullet, simulated in coarse cages, with detailed surfaces embedded in them.
//
// Choose your own units, with seconds for time; vectors are x, y, z; quaternions x, y, z, w; "n x 3" means 3 n
// contiguous numbers. Rest space is that of the mesh as it was read, world space that of the simulation.
//
// Views are typed arrays of the module's own memory: nothing is copied, and the next call that changes the object
// changes them. When the memory grows, which any call may cause, all earlier views have the length 0: get each view
// again where it is used, or compare `memoryVersion`, or copy it with `slice()`.

/** Version of the npm package. */
export const version: string;

/** Compiles and starts the module, with its own memory. Each call returns a new instance: they share nothing. */
export function load(): Promise<Tetskin>;

export type ErrorCode =
  | "FileNotFound" | "FileNotWritable" | "UnsupportedFormat" | "Malformed" | "Empty" | "IndexOutOfRange" | "NonFinite"
  | "Degenerate" | "SizeMismatch" | "InvalidOption" | "OutsideCage" | "CageMismatch" | "TooLarge" | "Asleep" | "Hidden"
  | "Unbound" | "TopologyChanged" | "NoHit" | "BodyDeleted" | "Released" | "OtherBody" | "NotInWorld" | "NotAdded"
  | "Enclosed" | "NotSaved" | "SnapshotMismatch" | "Cancelled"
  /** An argument has the wrong type or shape. */
  | "InvalidArgument"
  /** An object was used after its `delete()`, or its world's. */
  | "Deleted"
  /** There is not enough memory for this. Existing objects are unharmed. */
  | "OutOfMemory"
  /** The browser has no WebAssembly with SIMD and exceptions: the page on JavaScript lists the versions that have it. */
  | "Unsupported"
  /** A fault of tetskin itself; the message asks you to report it. */
  | "Internal";

/** Thrown by all functions. A failed call changes nothing, except on `NonFinite`, thrown after the step. */
export class TetskinError extends Error {
  readonly name: "TetskinError";
  /** The kind of error; `message` says what is wrong, and what to do. */
  readonly code: ErrorCode;
}

/** n numbers, as an array or a typed array. */
export type Numbers = ArrayLike<number>;
/** x, y, z */
export type Vector = Numbers;
/** x, y, z, w; need not be of unit length. */
export type Quaternion = Numbers;

declare global {
  interface SymbolConstructor {
    /** As in TypeScript's lib esnext.disposable, for programs compiled without it. */
    readonly dispose: unique symbol;
  }
}

/** An object in the module's memory. It is freed by `delete()`, or by `using` at the end of a block. */
export interface Thing {
  /** Frees it. Deleting again does nothing. Data that other objects still need stays until they are deleted. */
  delete(): void;
  readonly deleted: boolean;
  [Symbol.dispose](): void;
}

export interface Tetskin {
  /** Grows by 1 whenever the memory has grown: earlier views are then empty. */
  readonly memoryVersion: number;
  /** Bytes that the module has allocated; never shrinks. At most 2 GB. */
  readonly memoryBytes: number;

  /**
   * Reads a mesh file.
   * @param bytes   the whole file
   * @param format  its extension, in any case: obj, ply, off, stl, glb, gltf or vrm; a path or name with one is taken,
   *                too. A .gltf must have its buffers inside
   * @throws Malformed, UnsupportedFormat, Empty, IndexOutOfRange, NonFinite, OutOfMemory
   */
  readMesh(bytes: Uint8Array | ArrayBuffer, format: string): Mesh;
  /**
   * Reads a map painted on a mesh: a new array, of one number per vertex in the order of `readMesh`.
   * @param bytes, format  as for `readMesh`: ply, glb, gltf, vrm or obj
   * @param name  of a property of the vertices of a .ply; an attribute of one number of a .gltf, .glb or .vrm, such as
   *              _STIFFNESS; or red, green, blue or alpha, of vertex colours, 0 to 1
   * @throws InvalidOption, if the file has no such map: the message names those that it has; as `readMesh`
   */
  loadVertexMap(bytes: Uint8Array | ArrayBuffer, format: string, name: string): Float64Array;
  /**
   * A mesh of arrays.
   * @param positions  n x 3, any unit
   * @param triangles  m x 3 vertex indices, counter-clockwise from outside
   */
  createMesh(positions: Numbers, triangles: Numbers, options?: MeshArrays): Mesh;
  /** The mesh written by `toBytes`, in any instance of this version of the module. */
  meshFromBytes(bytes: Uint8Array): Mesh;

  /**
   * Builds a cage of tets around a mesh. The same input gives the same cage. Blocks until it is done, about half a
   * second for 60,000 triangles on a desktop: call it in a worker, and hand over `toBytes()`.
   * @throws Cancelled, Empty, Degenerate, InvalidOption, OutOfMemory
   */
  createCage(mesh: Mesh, options?: CageOptions): Cage;
  /** A copy with other maps painted on it. A map of ones removes what was painted before; without a map it stays. */
  paintCage(cage: Cage, mesh: Mesh, maps: PaintedMaps): Cage;
  /**
   * Spreads any map from the vertices of a mesh over its cage, whose inside has the values of the nearest surface. To
   * pin what is painted, take the nodes of at least 0.5 of a mask of 0 and 1.
   * @param values  one for each vertex
   * @throws SizeMismatch, NonFinite, InvalidOption: for the geometric mean, a value that is not above 0
   */
  spreadMap(cage: Cage, mesh: Mesh, values: Numbers, options?: SpreadOptions): SpreadMap;
  /**
   * Fibres for `addMuscle`: for each of these tets the direction of the nearest piece of a curve, a new array.
   * @param curve  m x 3, rest space: at least two points, not all in one place
   */
  fibresAlong(cage: Cage, tets: Numbers, curve: Numbers): Float64Array;
  /** A copy with stiffness factors that make the cage as compliant as the body in it. Takes seconds. */
  calibrate(cage: Cage, options?: CalibrationOptions): Cage;
  /** A cage of quadratic tets: each tet becomes one, stored as eight. For meshes that fill their cage. */
  refineQuadratic(cage: Cage): Cage;
  /** A cage of tets alone: n x 3 nodes, t x 4 node indices. */
  cageOfTets(nodes: Numbers, tets: Numbers): Cage;
  /** The cage written by `toBytes`, in any instance of this version of the module. */
  cageFromBytes(bytes: Uint8Array): Cage;

  /** The data that a GPU needs to draw a mesh in its cage. */
  createPalette(cage: Cage, mesh: Mesh, options?: PaletteOptions): Palette;

  createWorld(options?: WorldOptions): World;
}

export interface MeshArrays {
  /** n x 3, of unit length */
  normals?: Numbers;
  /** n x 2 */
  texcoords?: Numbers;
}

/** A surface at rest. It does not change. All arrays are views. */
export interface Mesh extends Thing {
  readonly vertexCount: number;
  readonly triangleCount: number;
  /** n x 3, rest space */
  readonly positions: Float64Array;
  /** m x 3 vertex indices */
  readonly triangles: Int32Array;
  /** n x 3 as in the file, or empty */
  readonly normals: Float32Array;
  /** n x 2 as in the file, or empty */
  readonly texcoords: Float32Array;
  /** n x 3, a new array: the file's normals, or those of the triangles, smooth across coincident vertices. */
  restNormals(): Float32Array;
  /** Two corners of its box: minimum x, y, z, maximum x, y, z; a new array. */
  readonly bounds: Float64Array;
  /** All of it as bytes, a new array; a worker may transfer its buffer. */
  toBytes(): Uint8Array;
}

export interface PaintedMaps {
  /** One factor above 0 per vertex of the mesh, of the stiffness there; the inside has those of the nearest surface */
  stiffness?: Numbers;
  /** The same for the density */
  density?: Numbers;
  /** The same for the damping, 0 or more */
  damping?: Numbers;
}

export interface SpreadOptions {
  /** geometric: of logarithms, for values above 0 that span decades, such as stiffness; "arithmetic" */
  mean?: "arithmetic" | "geometric";
}

/** New arrays. */
export interface SpreadMap {
  /** For each tet, the mean over the material in it */
  readonly tets: Float64Array;
  /** For each node, the mean of the tets around it */
  readonly nodes: Float64Array;
}

export interface CageOptions extends PaintedMaps {
  /** About how many tets; 3000 */
  targetTets?: number;
  /** Whether regions of the mesh that are near each other get a copy of a tet each; true */
  duplicateElements?: boolean;
  /** Whether the boundary is moved towards the surface; true */
  fit?: boolean;
  /** Called with the fraction done, 0 to 1; cancels by returning false. Its exceptions are passed on. */
  progress?: (fraction: number) => boolean | void;
}

export interface CalibrationOptions {
  /** Of the material that will be simulated; 0.3 */
  poissonRatio?: number;
  /** Number of vibrations to compare; 6 */
  modeCount?: number;
  /** As in CageOptions */
  progress?: (fraction: number) => boolean | void;
}

/** Tets at rest. It does not change. All arrays are views. */
export interface Cage extends Thing {
  readonly nodeCount: number;
  readonly tetCount: number;
  /** n x 3, rest space */
  readonly nodes: Float64Array;
  /** t x 4 node indices */
  readonly tets: Int32Array;
  /** For each vertex of the mesh that the cage was made for, the tet that carries it; or empty. */
  readonly vertexTets: Int32Array;
  /** For each tet, the number of the quadratic tet that it is an eighth of, or -1; or empty. */
  readonly quadraticTet: Int32Array;
  /** For each tet, the painted factor of the stiffness; or empty. */
  readonly paintedStiffness: Float64Array;
  /** For each node, its mass for a density of 1, or for the painted density; or empty. */
  readonly masses: Float64Array;
  /** e x 2 node indices of all edges, a new array. */
  edges(): Int32Array;
  /** f x 3 node indices of the boundary's faces, outwards, a new array. */
  boundaryFaces(): Int32Array;
  /** How it was made, and how well it fits; empty for a cage from arrays or `refineQuadratic`. */
  readonly report: string;
  /** A copy of another size, with masses to match. */
  scaled(scale: number): Cage;
  /** All of it as bytes, a new array; a worker may transfer its buffer. */
  toBytes(): Uint8Array;
}

export interface PaletteOptions {
  /** Of the surface; "linear" */
  interpolation?: "linear" | "quadratic";
  /** Whether bones of the linear surface have the gradients of their nodes, for normals in a shader; false. */
  gradients?: boolean;
  /** rows: 12 floats per bone, 3 rows of 4; columns: 16 floats, a matrix for WebGL; "rows" */
  layout?: "rows" | "columns";
}

/**
 * Bones [A | t], one per node, for a vertex shader that draws the surface. With the four bones and weights b of a
 * vertex at X, rest space:
 *   position            sum of b_i (A_i X + t_i)
 *                       linear with gradients: X + sum of b_i t_i
 *   normal              normalize(cofactor(sum of b_i A_i) N), N the normal at rest
 * Bones of the linear surface without gradients have A = 1, and do not turn normals. Needs no world.
 */
export interface Palette extends Thing {
  readonly boneCount: number;
  /** vertices x 4: which bones carry a vertex, a new array. */
  vertexBones(): Uint16Array;
  /** vertices x 4: the bones' weights, a new array. They sum to 1; a vertex outside has negative ones. */
  vertexWeights(): Float32Array;
  /** A view of boneCount x 12 or 16 floats, which the next update overwrites. */
  readonly bones: Float32Array;
  /**
   * Computes the bones, and returns them.
   * @param nodes  n x 3, world space; or a body with this cage
   */
  update(nodes: Numbers | Body): Float32Array;
}

export interface WorldOptions {
  /** World length / s^2; 0, -9.81, 0 */
  gravity?: Vector;
  /** The same bits in every browser and on every processor, as natively, for some percent of the time; false */
  deterministic?: boolean;
  /** For `forcesOn`: costs some time per contact point; false. It changes nothing else. */
  recordForces?: boolean;
  /** Seconds at rest until soft bodies, and what they lie on or carry, fall asleep: at least 0; Infinity: never; 0.5 */
  sleepAfter?: number;
  /** Into how many parts steps may be divided while a body with little damping hits something: 1 to 64; 4 */
  impactParts?: number;
}

/** A force, and its torque about the centre of mass of the object that it acts on; world space. */
export interface Wrench {
  /** Mass length / s^2, a new array */
  readonly force: Float64Array;
  /** Mass length^2 / s^2, a new array */
  readonly torque: Float64Array;
}

/** Forces by cause: the mean over the last step. */
export interface AppliedForces {
  /** Normal forces of contacts */
  readonly contact: Wrench;
  /** Tangential to the contacts */
  readonly friction: Wrench;
  /** Springs */
  readonly joints: Wrench;
  /** The sum of all */
  readonly total: Wrench;
}

/** Milliseconds of the last `step`, by stage, in the order in which each substep runs them. */
export interface StageTimes {
  /** Forces, and the elastic solve without contacts */
  readonly prediction: number;
  /** The search for contacts with rigid bodies, and between these */
  readonly rigidSearch: number;
  /** The search for contacts among soft bodies */
  readonly softSearch: number;
  /** Collecting contacts, springs and pins */
  readonly rows: number;
  /** The solve with them */
  readonly system: number;
  /** What is left: Bullet's own work */
  readonly other: number;
  /** Visible surfaces, on the CPU */
  readonly surfaces: number;
  /** Of all */
  readonly total: number;
}

export interface RigidOptions {
  /** 0 for one that does not move by itself; 0 */
  mass?: number;
  position?: Vector;
  rotation?: Quaternion;
  /** World length / s */
  velocity?: Vector;
  /** Radians / s */
  angularVelocity?: Vector;
  /** Coulomb's coefficient, which is multiplied by that of the touched object; 0.5 */
  friction?: number;
  /** Whether it is moved by assigning its position and rotation; false */
  kinematic?: boolean;
}

export interface BodyOptions {
  /** Of the rest space in the world; 0, 0, 0 */
  position?: Vector;
  /** Of the rest space in the world; 0, 0, 0, 1 */
  rotation?: Quaternion;
  /** Nodes to pin: their indices */
  pinned?: Numbers;
  /** Mass per volume of the mesh; 100 */
  density?: number;
  /** Total mass, in place of the density */
  mass?: number;
  /** Of each node, in place of mass and density */
  nodeMasses?: Numbers;
  /** Pressure units; without it, relativeStiffness tells */
  youngsModulus?: number;
  /** Young's modulus over density x gravity x size: from 30 (wobbles, sags) to 300 (firm); 50 */
  relativeStiffness?: number;
  /** Factors of the stiffness, one for each tet; without it, those of the cage */
  stiffnessScale?: Numbers;
  /** 0 to below 0.5; 0.3 */
  poissonRatio?: number;
  /** Seconds: Rayleigh damping; 0.02 */
  stiffnessDamping?: number;
  /** 0 to 1; 0.5 */
  friction?: number;
  /**
   * 0 to 1. The product of both objects', so both need one, is the least share of the speed of approach with which they
   * part; 0
   */
  restitution?: number;
  /** How the surface follows the tets; "linear" */
  interpolation?: "linear" | "quadratic";
  /** "none" */
  normals?: "none" | "transformed" | "recomputed";
  /** How vertices outside the tets are bound; "nearest" */
  outside?: "nearest" | "barycentric";
  /** How far outside a vertex may be, rest length; without it, any distance */
  maxDistance?: number;
  /** Degrees: recomputed normals stay split where rest normals at an edge differ by more than this; 5 */
  hardEdgeDegrees?: number;
  /** Whether steps compute the surface, on the CPU; true. With a Palette, false saves their time. */
  visible?: boolean;
  /** Contact with rigid bodies at the visible surface, otherwise at nodes; true */
  surfaceContact?: boolean;
  /** Contact with other bodies that have it; takes a second for 20,000 triangles, once; false */
  softContact?: boolean;
  /** The same, and contact with itself; false */
  selfContact?: boolean;
  /** Collision margin of the nodes, world length; without it, 2 % of the size */
  margin?: number;
  /** Of the solver: forces left, relative to those that act, 0 to below 1; 0.005 */
  solverTolerance?: number;
  /** Of each solve, at most; 100 */
  maxIterations?: number;
  /** The distance kept, world length; without it, 0.2 % of the size */
  contactMargin?: number;
  /** Triangles with longer edges get points in between that collide, too, rest length; without it, by the tets' size */
  sampleSpacing?: number;
}

/** A world of soft and rigid bodies, which it keeps: deleting it deletes them. */
export interface World extends Thing {
  gravity: Float64Array | Vector;
  /**
   * Advances by dt seconds in `substeps` of Bullet's steps; 1/60 and 4 by default.
   * @returns the number of steps made
   * @throws NonFinite, after the step, if the simulation is unstable: restore a snapshot
   */
  step(dt?: number, substeps?: number): number;
  /** Durations of the last step. */
  readonly times: StageTimes;
  /** Seconds simulated since the world was made. Not part of snapshots. */
  readonly time: number;

  /** Everything below a plane: normal . x < offset; y < 0 by default. */
  addPlane(options?: {normal?: Vector; offset?: number; friction?: number}): RigidBody;
  addBox(halfExtents: Vector, options?: RigidOptions): RigidBody;
  addSphere(radius: number, options?: RigidOptions): RigidBody;
  /** Along y; height: of the part between the caps. */
  addCapsule(radius: number, height: number, options?: RigidOptions): RigidBody;
  /** Along y. */
  addCylinder(radius: number, height: number, options?: RigidOptions): RigidBody;
  /** The convex hull of n x 3 points. */
  addConvexHull(points: Numbers, options?: RigidOptions): RigidBody;
  /** A surface, for bodies without mass: collides on the side from which triangles look counter-clockwise. */
  addMesh(mesh: Mesh, options?: RigidOptions): RigidBody;
  /** A soft body. Without a mesh (null) it has no surface, and collides at its nodes. */
  addBody(cage: Cage, mesh: Mesh | null, options?: BodyOptions): Body;

  /** In the order in which they were added. */
  readonly bodies: readonly Body[];
  /** In the order in which they were added. */
  readonly rigidBodies: readonly RigidBody[];
  /** For all rigid bodies, 7 numbers each: position and rotation. A view, which the next call overwrites. */
  poses(): Float32Array;

  /** The first intersection of the segment with the surfaces of soft bodies, or null. */
  raycast(start: Vector, end: Vector): Hit | null;
  /** Pulls the surface point that a ray has hit to its current position, which `setTarget` moves. */
  addSpring(hit: Hit, options?: SpringOptions): Spring;
  /** Mass times velocity, at the point of a hit; acts at once. */
  applyImpulse(hit: Hit, impulse: Vector): void;

  /**
   * Forces on a soft body from all objects that it touches or is attached to, or on a rigid body from all soft ones;
   * with `other`, from that one alone.
   * @throws NotAdded, if the world was made without `recordForces`
   */
  forcesOn(thing: Body | RigidBody, other?: Body | RigidBody): AppliedForces;

  /** Size of a snapshot of the current state, in bytes. */
  readonly snapshotSize: number;
  /**
   * The state. After `restore` the world continues to the last bit, in this instance or another.
   * @param into  memory for it of at least snapshotSize bytes; without it, new memory
   * @returns the part of `into` that was written
   */
  save(into?: Uint8Array): Uint8Array;
  /** Restores a state. The world must have the same bodies and springs as then, made in the same order. */
  restore(snapshot: Uint8Array): void;
  /** Makes a point the origin: the world continues as before, with smaller coordinates, which floats resolve better. */
  shiftOrigin(origin: Vector): void;
  /** A hash of the positions and velocities of all nodes and rigid bodies, to the last bit: 16 hexadecimal digits. */
  readonly hash: string;
}

/** Where a ray has hit a surface. */
export interface Hit {
  readonly body: Body;
  /** Index in the mesh */
  readonly triangle: number;
  /** Barycentric weights of the triangle's corners */
  readonly weights: readonly [number, number, number];
  /** World space */
  readonly point: readonly [number, number, number];
  /** The triangle's, unit length */
  readonly normal: readonly [number, number, number];
  /** From the start of the ray, world length */
  readonly distance: number;
}

export interface SpringOptions {
  /** Divided by a point's mass, in 1 / (1/240 s)^2; 10 */
  stiffness?: number;
  /** 0 */
  dampingRatio?: number;
  /** Without it, a few times the body's weight */
  maxForce?: number;
}

/** Deleting it lets go. */
export interface Spring extends Thing {
  readonly body: Body;
  /** World space */
  setTarget(target: Vector): void;
  setStiffness(stiffness: number): void;
  setMaxForce(force: number): void;
  /** Where the point of the surface is, world space; a new array. */
  readonly position: Float64Array;
  /** On the body in the last step, world space; a new array. */
  readonly force: Float64Array;
  /** From the point to the target, world length */
  readonly stretch: number;
}

/** Deleting it takes it out of its world. */
export interface RigidBody extends Thing {
  /** World space, a new array. A kinematic body moves to an assigned position in the next step. */
  get position(): Float64Array;
  set position(at: Vector);
  /** A new array. */
  get rotation(): Float64Array;
  set rotation(quaternion: Quaternion);
  get velocity(): Float64Array;
  set velocity(velocity: Vector);
  get angularVelocity(): Float64Array;
  set angularVelocity(velocity: Vector);
  friction: number;
  /** 0 to 1, by default 0. The product of both objects' counts, so both need one: see `BodyOptions`. */
  restitution: number;
  readonly mass: number;
  readonly kinematic: boolean;
  /** Mass times velocity, at a point in world space, or at the centre of mass. */
  applyImpulse(impulse: Vector, at?: Vector): void;
}

/** Tets of a body that contract along their fibres. The body keeps it. */
export interface Muscle {
  /** 0 to 1, at first 0: the share of its stress with which it pulls. */
  activation: number;
}

/** Deleting it takes it out of its world, with its springs. */
export interface Body extends Thing {
  readonly cage: Cage;
  /** Null without a surface */
  readonly mesh: Mesh | null;
  readonly nodeCount: number;
  /** n x 3, world space. A view, which this call fills, and the next one overwrites. */
  readonly nodes: Float32Array;
  /** n x 3, world length / s. A view, like nodes. */
  get velocities(): Float32Array;
  /** n x 3. Velocities of pinned nodes stay. */
  set velocities(velocities: Numbers);
  /** vertices x 3, world space. A view, which each step overwrites if the body is visible. */
  readonly positions: Float32Array;
  /** vertices x 3, or empty. A view, like positions. */
  readonly normals: Float32Array;
  /** Two corners of the surface's box, world space; a new array. */
  readonly bounds: Float64Array;
  /** Whether steps compute positions and normals. When shown again, they are computed at once. */
  visible: boolean;
  /** Whether it sleeps. */
  readonly asleep: boolean;
  /** Total, without pinned nodes */
  readonly mass: number;
  youngsModulus: number;
  readonly relativeStiffness: number;
  poissonRatio: number;
  stiffnessDamping: number;
  /** Inside its hollows, or the whole of a body without any, above that outside; pressure units; 0: none. */
  pressure: number;
  /** The volume that pressure fills. */
  readonly volume: number;
  /**
   * Fills it with a gas of this pressure: from now on (pressure + outside) x volume is constant.
   * @param outside  absolute pressure outside; 0, or 101325 for a real tyre in Pa
   */
  setGas(pressure: number, outside?: number): void;
  /**
   * Sets the surface on which pressure acts, and whose volume counts. By default it is that of the body, if it is
   * closed. A gas keeps its present pressure.
   * @param mesh  closed, in the cage, rest space, such as an inner wall; null: the boundary of the tets
   */
  setPressureSurface(mesh: Mesh | null): void;
  friction: number;
  /** 0 to 1. The product of both objects' counts, so both need one: see `BodyOptions`. */
  restitution: number;
  /**
   * Lets the material flow where it yields, as clay does; null: nothing flows any more. `yieldStress`: pressure units,
   * the von Mises stress, one for all tets or one for each. `hardening`: pressure units per plastic strain. `flowRate`:
   * per second, at which what is beyond it flows; by default at once. `largest`: the largest plastic strain that may
   * remain, logarithmic; by default 3, a stretch by 20.
   */
  setPlasticity(
    plasticity: {yieldStress: number | Numbers; hardening?: number; flowRate?: number; largest?: number} | null): void;
  /** The body returns to its first shape; it flows again when it has been there for half a second. */
  resetPlasticFlow(): void;
  /** By tet: how much it has flowed in all, to and fro; a new array. */
  readonly plasticStrains: Float64Array;
  /**
   * Makes tets grow to multiples of their first size, at which they are at rest; masses stay.
   * @param growth  a factor of length, 0.05 to 20; one for each tet; or a symmetric matrix for each, nine numbers
   */
  setGrowth(growth: number | Numbers): void;
  /**
   * Multiplies the stiffness of each tet, as it was when the body was made. A large change in one step is a blow to a
   * body under load.
   * @param factors  one for each tet, 1e-6 to 1e6
   */
  setStiffnessScale(factors: Numbers): void;
  /**
   * Multiplies the damping of each tet, on top of what is painted in the cage.
   * @param factors  one for each tet, 0 or more
   */
  setDampingScale(factors: Numbers): void;
  /**
   * How stress follows from large strains. Small strains are the same with each law. Yeoh's stiffens when it is pulled,
   * as rubber and flesh do, with C20 / C10 = c2 and C30 / C10 = c3.
   * @param tets  of the cage; null: all
   */
  setElasticLaw(law: "corotated" | "neo-hookean" | "yeoh", coefficients?: {c2?: number, c3?: number},
                tets?: Numbers | null): void;
  /**
   * Adds fibres that make tets stiffer along them, for good.
   * @param tets         of the cage
   * @param directions   rest space: one, or one for each of these tets, three numbers each
   * @param stiffness    their tension on the area at rest per strain, pressure units
   * @param tensionOnly  nothing resists where they become shorter, as a rope
   */
  addFibres(tets: Numbers, directions: Numbers, stiffness: number, tensionOnly?: boolean): void;
  /**
   * Adds a muscle, which is relaxed.
   * @param tets    of the cage
   * @param fibres  directions, rest space: one, or one for each of these tets, three numbers each
   * @param stress  its tension at activation 1 and its rest length, pressure units
   * @param lengthFactors  pairs of a stretch along it, ascending, and the factor of the tension there, linear between
   *                       them: it then pulls at any length by them, beside its elasticity
   */
  addMuscle(tets: Numbers, fibres: Numbers, stress?: number, lengthFactors?: Numbers): Muscle;
  /** Its own gravity; null: the world's. */
  setGravity(gravity: Vector | null): void;
  /** Pins nodes at their current positions, or releases them. */
  setPinned(nodes: Numbers, pinned?: boolean): void;
  /** For each node 1 if it is pinned, otherwise 0; a new array. */
  readonly pinned: Uint8Array;
  /** Moves pinned nodes to n x 3 positions, world space, in the next step: once per frame. */
  setPinnedPositions(nodes: Numbers, positions: Numbers): void;
  /**
   * Moves the body at once, without stopping it: rotated about the world's origin, then by position. Velocities, pins
   * and vibrations move along, and nothing on the way collides.
   */
  transform(position: Vector, rotation?: Quaternion): void;
  /** Puts the body back to where it was added, at rest; settings stay. Its steps are then those of a new body. */
  reset(): void;
  /**
   * Pushes the surface in a ball away from its centre.
   * @param strength  sum of the magnitudes at all vertices: mass times velocity
   * @returns the number of vertices pushed
   */
  applyRadialImpulse(centre: Vector, radius: number, strength: number): number;
}
