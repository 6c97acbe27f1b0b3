// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

class Mesh extends Thing {
  get vertexCount() {
    return this.core.meshPositions(own(this)).count / 3;
  }
  get triangleCount() {
    return this.core.meshTriangles(own(this)).count / 3;
  }
  restNormals() {
    return this.copy(Float32Array, this.core.meshRestNormals(own(this)));
  }
  toBytes() {
    return this.copy(Uint8Array, this.core.meshToBytes(own(this)));
  }
}
properties(Mesh, {
  positions: [viewOf(Float64Array), "meshPositions"],
  triangles: [viewOf(Int32Array), "meshTriangles"],
  normals: [viewOf(Float32Array), "meshNormals"],
  texcoords: [viewOf(Float32Array), "meshTexcoords"],
  bounds: [copyOf(Float64Array), "meshBounds"],
});

class Cage extends Thing {
  get nodeCount() {
    return this.core.cageNodes(own(this)).count / 3;
  }
  get tetCount() {
    return this.core.cageTets(own(this)).count / 4;
  }
  edges() {
    return this.copy(Int32Array, this.core.cageEdges(own(this)));
  }
  boundaryFaces() {
    return this.copy(Int32Array, this.core.cageBoundaryFaces(own(this)));
  }
  scaled(scale) {
    return new Cage(this.hidden.instance, this.core.scaledCage(own(this), numberOf(scale, "scale")));
  }
  toBytes() {
    return this.copy(Uint8Array, this.core.cageToBytes(own(this)));
  }
}
properties(Cage, {
  nodes: [viewOf(Float64Array), "cageNodes"],
  tets: [viewOf(Int32Array), "cageTets"],
  vertexTets: [viewOf(Int32Array), "cageVertexTets"],
  quadraticTet: [viewOf(Int32Array), "cageQuadraticTet"],
  paintedStiffness: [viewOf(Float64Array), "cagePaintedStiffness"],
  masses: [viewOf(Float64Array), "cageMasses"],
  report: [kWords, "cageReport"],
});

class Palette extends Thing {
  vertexBones() {
    return this.copy(Uint16Array, this.core.vertexBones(own(this)));
  }
  vertexWeights() {
    return this.copy(Float32Array, this.core.vertexWeights(own(this)));
  }
  update(nodes) {
    if (nodes instanceof Body) {
      const body = handleIn(this.hidden.instance, nodes, Body, "nodes");
      return this.view(Float32Array, this.core.updatePaletteByBody(own(this), body));
    }
    return this.withMemory([doubles(numbersOf(nodes, "nodes", 3))], at => {
      return this.view(Float32Array, this.core.updatePaletteByNumbers(own(this), at));
    });
  }
}
properties(Palette, {
  boneCount: [kNumber, "boneCount"],
  bones: [viewOf(Float32Array), "bones"],
});

const kFormats = ["obj", "ply", "off", "stl", "glb", "gltf", "vrm"];
const kCageOptions = {
  targetTets: 3000, duplicateElements: true, fit: true, stiffness: [], density: [], damping: [], progress: undefined,
};
const kCalibrationOptions = {poissonRatio: 0.3, modeCount: 6, progress: undefined};
const kWorldOptions = {
  gravity: [0, -9.81, 0], deterministic: false, recordForces: false, sleepAfter: 0.5, impactParts: 4,
};
const kPaletteOptions = {interpolation: "linear", gradients: false, layout: "rows"};

/** The result of `load`. */
class Tetskin {
  constructor(core) {
    Object.defineProperty(this, "hidden", {value: {instance: new Instance(core)}});
  }
  get memoryVersion() {
    this.hidden.instance.countGrowth();
    return this.hidden.instance.memoryVersion;
  }
  get memoryBytes() {
    return this.hidden.instance.buffer.byteLength;
  }

  readMesh(bytes, format) {
    return this.withFile(bytes, format, (...file) => new Mesh(this.hidden.instance, this.core.readMesh(...file)));
  }
  loadVertexMap(bytes, format, name) {
    if (typeof name !== "string") throw invalid("name: must be a string, for instance red");
    return this.withFile(bytes, format, (...file) => this.copy(Float64Array, this.core.loadVertexMap(...file, name)));
  }
  /** Calls `work` with the place of a file's bytes, and its extension. */
  withFile(bytes, format, work) {
    const content = bytesOf(bytes, "bytes");
    if (typeof format !== "string") throw invalid("format: must be a string, for instance obj");
    const extension = format.slice(format.lastIndexOf(".") + 1).toLowerCase();
    if (!kFormats.includes(extension)) {
      throw new TetskinError("UnsupportedFormat", `format: ${format} is none of ${kFormats.join(", ")}`);
    }
    return this.withBytes(content, (at, count) => work(at, count, extension));
  }
  createMesh(positions, triangles, options) {
    const {normals, texcoords} = optionsOf(options, {normals: [], texcoords: []});
    numbersOf(positions, "positions", 3);
    numbersOf(triangles, "triangles", 3);
    for (const [array, name, columns] of [[normals, "normals", 3], [texcoords, "texcoords", 2]]) {
      if (array.length !== 0 && array.length !== columns * positions.length / 3) {
        throw new TetskinError("SizeMismatch", `${name}: ${array.length} numbers for ${positions.length / 3} vertices`);
      }
    }
    const arrays = [doubles(positions), indices(triangles), doubles(normals), doubles(texcoords)];
    return this.withMemory(arrays, (...places) => new Mesh(this.hidden.instance, this.core.createMesh(...places)));
  }
  meshFromBytes(bytes) {
    return this.withBytes(bytesOf(bytes, "bytes"), (at, count) =>
      new Mesh(this.hidden.instance, this.core.meshFromBytes(at, count)));
  }

  createCage(mesh, options) {
    const {targetTets, duplicateElements, fit, stiffness, density, damping, progress} =
      optionsOf(options, kCageOptions);
    const handle = this.handle(mesh, Mesh, "mesh");
    return this.withMemory(this.mapsOf(mesh, {stiffness, density, damping}), (...maps) =>
      this.withProgress(progress, tells => new Cage(this.hidden.instance, this.core.createCage(
        handle, targetTets, duplicateElements, fit, ...maps, tells))));
  }
  paintCage(cage, mesh, maps) {
    const painted = optionsOf(maps, {stiffness: [], density: [], damping: []});
    const handles = [this.handle(cage, Cage, "cage"), this.handle(mesh, Mesh, "mesh")];
    return this.withMemory(this.mapsOf(mesh, painted), (...places) =>
      new Cage(this.hidden.instance, this.core.paintCage(...handles, ...places)));
  }
  spreadMap(cage, mesh, values, options) {
    const {mean} = optionsOf(options, {mean: "arithmetic"});
    if (mean !== "arithmetic" && mean !== "geometric") throw invalid("mean: \"arithmetic\" or \"geometric\"");
    const handles = [this.handle(cage, Cage, "cage"), this.handle(mesh, Mesh, "mesh")];
    const numbers = this.withMemory([doubles(numbersOf(values, "values"))], at =>
      this.copy(Float64Array, this.core.spreadMap(...handles, at, mean === "geometric")));
    return {tets: numbers.slice(0, cage.tetCount), nodes: numbers.slice(cage.tetCount)};
  }
  fibresAlong(cage, tets, curve) {
    const handle = this.handle(cage, Cage, "cage");
    return this.withMemory([indices(numbersOf(tets, "tets")), doubles(numbersOf(curve, "curve", 3))], (...places) =>
      this.copy(Float64Array, this.core.fibresAlong(handle, ...places)));
  }
  calibrate(cage, options) {
    const {poissonRatio, modeCount, progress} = optionsOf(options, kCalibrationOptions);
    const handle = this.handle(cage, Cage, "cage");
    return this.withProgress(progress, tells => new Cage(this.hidden.instance, this.core.calibrate(
      handle, poissonRatio, wholeNumberOf(modeCount, "modeCount"), tells)));
  }
  refineQuadratic(cage) {
    return new Cage(this.hidden.instance, this.core.refineQuadratic(this.handle(cage, Cage, "cage")));
  }
  cageOfTets(nodes, tets) {
    numbersOf(nodes, "nodes", 3);
    numbersOf(tets, "tets", 4);
    return this.withMemory([doubles(nodes), indices(tets)], (...places) =>
      new Cage(this.hidden.instance, this.core.cageOfTets(...places)));
  }
  cageFromBytes(bytes) {
    return this.withBytes(bytesOf(bytes, "bytes"), (at, count) =>
      new Cage(this.hidden.instance, this.core.cageFromBytes(at, count)));
  }

  createPalette(cage, mesh, options) {
    const {interpolation, gradients, layout} = optionsOf(options, kPaletteOptions);
    if (layout !== "rows" && layout !== "columns") throw invalid("layout: \"rows\" or \"columns\"");
    return new Palette(this.hidden.instance, this.core.createPalette(
      this.handle(cage, Cage, "cage"), this.handle(mesh, Mesh, "mesh"), interpolation, gradients,
      layout === "columns"));
  }
  createWorld(options) {
    const {gravity, deterministic, recordForces, sleepAfter, impactParts} = optionsOf(options, kWorldOptions);
    return new World(this.hidden.instance, this.core.createWorld(
      gravity, deterministic, recordForces, sleepAfter, wholeNumberOf(impactParts, "impactParts")));
  }

  handle(thing, Type, name) {
    return handleIn(this.hidden.instance, thing, Type, name);
  }
  /** Painted maps, each of which has a number for each vertex, or none. */
  mapsOf(mesh, maps) {
    return Object.entries(maps).map(([name, map]) => {
      if ([0, mesh.vertexCount].includes(map.length)) return doubles(map);
      throw new TetskinError("SizeMismatch", `${name}: ${map.length} numbers for ${mesh.vertexCount} vertices`);
    });
  }
  /** An exception of a progress function cancels, and is thrown afterwards. */
  withProgress(progress, work) {
    if (progress === undefined) return work(false);
    let thrown;
    const before = this.core.progress;
    this.core.progress = fraction => {
      try {
        return progress(fraction) !== false;
      } catch (error) {
        thrown = {error};
        return false;
      }
    };
    try {
      return work(true);
    } catch (error) {
      throw thrown ? thrown.error : error;
    } finally {
      this.core.progress = before;
    }
  }
}

for (const Type of [Thing, Tetskin]) {
  Object.defineProperties(Type.prototype, {
    core: {get() { return this.hidden.instance.core; }},
    view: {value(Numbers, place) { return this.hidden.instance.view(Numbers, place); }},
    copy: {value(Numbers, place) { return this.hidden.instance.copy(Numbers, place); }},
    withMemory: {value(arrays, work) { return this.hidden.instance.withMemory(arrays, work); }},
    withBytes: {value(values, work) {
      return this.withMemory([{Type: Uint8Array, values}], ({at, count}) => work(at, count));
    }},
  });
}
