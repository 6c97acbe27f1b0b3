// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The memory that all objects of one instance share.

const kNothing = {at: 0, count: 0};
const kMostBytes = 0x7fffffff;  // of a 32-bit address space, where sizes would wrap

const doubles = values => ({Type: Float64Array, values});
const indices = values => ({Type: Int32Array, values: checkedIndices(values)});

/** A C++ exception passes Guarded only if there is no memory for arguments or results. */
function withoutExceptions(call) {
  return (...values) => {
    try {
      return call(...values);
    } catch (error) {
      throw error instanceof WebAssembly.Exception ? errorOf("OutOfMemory") : error;
    }
  };
}

class Instance {
  constructor(core) {
    this.core = core;
    for (const [name, call] of Object.entries(core)) {
      if (typeof call === "function" && /^[a-z]/.test(name)) core[name] = withoutExceptions(call);
    }
    // Asked for once: a call may make memory grow, and take its views from the arguments of another one.
    this.bodyOptions = {...core.bodyOptions(), pinned: [], nodeMasses: [], stiffnessScale: []};
    this.memoryVersion = 0;
    this.seen = this.buffer;
  }

  get buffer() {
    return this.core.HEAPU8.buffer;
  }

  /** A memory that has grown has another array buffer. */
  countGrowth() {
    if (this.seen === this.buffer) return;
    this.seen = this.buffer;
    ++this.memoryVersion;
  }

  /** Calls `work` with the addresses of copies of some arrays, which are freed afterwards. */
  withMemory(arrays, work) {
    const taken = [], own = values => ArrayBuffer.isView(values) && values.buffer === this.buffer;
    const put = ({Type, values}) => {
      if (values.length === 0) return kNothing;
      const bytes = values.length * Type.BYTES_PER_ELEMENT, at = bytes > kMostBytes ? 0 : this.core._malloc(bytes);
      if (at === 0) throw errorOf("OutOfMemory");
      taken.push(at);
      new Type(this.buffer, at, values.length).set(values);
      return {at, count: values.length};
    };
    try {
      // If the memory grows for one array, views of it are detached: these are copied before.
      const kept = arrays.map(({Type, values}) => ({Type, values: own(values) ? new Type(values) : values}));
      return work(...kept.map(put));
    } finally {
      for (const at of taken) this.core._free(at);
    }
  }

  view(Type, {at, count}) {
    return new Type(this.buffer, at, count);
  }
  copy(Type, lent) {
    return this.view(Type, lent).slice();
  }
}

function checkedIndices(values) {
  for (let i = 0; i < values.length; ++i) {
    if (!(values[i] >= -0x80000000 && values[i] <= 0x7fffffff) || values[i] % 1 !== 0) {
      throw invalid(`an index is ${values[i]}: it must be a whole number`);
    }
  }
  return values;
}

/** An object of an instance, which is freed by `delete()`. */
class Thing {
  constructor(instance, handle) {
    Object.defineProperty(this, "hidden", {value: {instance, handle}});
  }
  get deleted() {
    return this.hidden.handle === null;
  }
  delete() {
    const {handle} = this.hidden;
    if (handle === null) return;
    this.leave(handle);
    this.hidden.handle = null;
    handle.delete();
  }
  /** Called before the handle is freed; if this throws, nothing is freed. */
  leave() {}
}
Object.defineProperty(Thing.prototype, Symbol.dispose ?? Symbol.for("Symbol.dispose"), {
  value() {
    this.delete();
  },
});

/** An object's handle, for a call. */
function handleOf(thing, Type, name) {
  if (!(thing instanceof Type)) throw invalid(`${name}: must be a ${Type.name}`);
  if (thing.deleted) throw new TetskinError("Deleted", `${name}: it has been deleted`);
  return thing.hidden.handle;
}

/** The handle of the object whose method was called. */
function own(thing) {
  if (thing.deleted) throw new TetskinError("Deleted", `the ${thing.constructor.name} has been deleted`);
  return thing.hidden.handle;
}

/** Handles of other instances refer to other memory. */
function handleIn(instance, thing, Type, name) {
  const handle = handleOf(thing, Type, name);
  if (thing.hidden.instance !== instance) {
    throw invalid(`${name}: is of another instance of the module; hand over its bytes`);
  }
  return handle;
}

/** Kinds of properties: how the module's value is converted, and how a given one is checked. */
const kNumber = {made: value => value, checked: numberOf}, kBoolean = {made: value => value, checked: booleanOf};
const kVector = {made: numbers => Float64Array.from(numbers), checked: vectorOf};
const kQuaternion = {made: kVector.made, checked: (value, name) => vectorOf(value, name, 4)};
const kWords = {made: words => words};
const viewOf = Type => ({made: (place, thing) => thing.view(Type, place)});
const copyOf = Type => ({made: (place, thing) => thing.copy(Type, place)});

/** Adds properties to a class: by name, their kind, and the module's functions that read and set them. */
function properties(Type, all) {
  for (const [name, [kind, read, write]] of Object.entries(all)) {
    Object.defineProperty(Type.prototype, name, {
      configurable: true,
      get() {
        return kind.made(this.core[read](own(this)), this);
      },
      set: write && function(value) {
        this.core[write](own(this), kind.checked(value, name));
      },
    });
  }
}
