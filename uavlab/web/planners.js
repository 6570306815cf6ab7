// planners.wasm for a page: its memory, arrays in it, and calls of its functions by their names.
"use strict";

async function loadPlanners(code, facts) {
  const sizes = new Map(), free = new Map();  // of blocks of memory, by where they begin; and those to be had again, by size
  let memory, top;
  function take(bytes) {
    const size = Number(bytes) + 63 & ~63, again = free.get(size);
    if (again?.length) return again.pop();
    const at = top, missing = at + size - memory.buffer.byteLength;
    if (missing > 0) memory.grow(Math.ceil(missing / 65536));
    top += size;
    sizes.set(at, size);
    return at;
  }
  function give(at) {
    const size = sizes.get(at);
    if (!free.has(size)) free.set(size, []);
    free.get(size).push(at);
  }
  const HEAD = 64;  // of a block that numba counts the users of: their number, and at 16 where its data are
  const given = {
    NRT_MemInfo_alloc_aligned(bytes) {
      const at = take(Number(bytes) + HEAD), view = new DataView(memory.buffer, at, HEAD);
      view.setBigUint64(0, 1n, true);
      view.setUint32(16, at + HEAD, true);
      return at;
    },
    NRT_MemInfo_call_dtor: give, NRT_Allocate: take, NRT_Free: give,
    exp: Math.exp, log1p: Math.log1p, hypot: Math.hypot, sin: Math.sin, acos: Math.acos,
  };
  const module = await WebAssembly.compile(code);
  const env = {};
  for (const {name} of WebAssembly.Module.imports(module))
    env[name] = given[name] ?? (() => { throw new Error(`planners.wasm asked for ${name}, which the page hasn't`); });
  const {exports} = await WebAssembly.instantiate(module, {env});
  memory = exports.memory;
  top = exports.__heap_base.value + 63 & ~63;

  const KINDS = {boolean: Uint8Array, int32: Int32Array, int64: BigInt64Array, uint64: BigUint64Array, float64: Float64Array};
  class Numbers {  // an array in the module's memory
    constructor(kind, ...shape) {
      this.kind = kind;
      this.shape = shape;
      this.length = shape.reduce((product, count) => product * count, 1);
      this.at = take(KINDS[kind].BYTES_PER_ELEMENT * this.length);
    }
    get values() { return new KINDS[this.kind](memory.buffer, this.at, this.length); }  // until memory grows
    set(values) { this.values.set(values); return this; }
    free() { give(this.at); }
  }
  const answer = new Numbers("float64", 2);
  const numbers = (kind, values, shape = [values.length]) => new Numbers(kind, ...shape).set(values);
  const planners = {numbers, empty: (kind, ...shape) => new Numbers(kind, ...shape), used: () => top};
  for (const [name, {takes, gives}] of Object.entries(facts.functions))
    planners[name] = (...passed) => {
      const flat = takes.flatMap(([argument, kind, axes], n) => {
        const value = passed[n];
        if (axes === 0) { if (typeof value !== "number") throw new Error(`${name}: ${argument} must be a number`); return [value]; }
        if (value?.kind !== kind || value.shape.length !== axes) throw new Error(`${name}: ${argument} must be ${kind} with ${axes} axes`);
        return [value.at, ...value.shape];
      });
      if (passed.length !== takes.length) throw new Error(`${name} takes ${takes.length} arguments, got ${passed.length}`);
      const status = exports[name](answer.at, answer.at + 8, ...flat);
      if (status !== 0) throw new Error(`${name} failed (${status})`);
      return gives === "float64" ? answer.values[0] : Number(new BigInt64Array(memory.buffer, answer.at, 1)[0]);
    };
  return planners;
}
