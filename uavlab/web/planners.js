// planners.wasm for a page: its memory, arrays in it, and calls of its functions by their names.
"use strict";

async function loadPlanners(code, facts) {
  const HEAD = 64;  // of a block: its size at 0; and, for arrays, what numba knows of it at 64: users, and where its data are
  const free = new Map();  // blocks to be had again, by size
  let memory, top, words;
  function take(bytes) {
    const size = Number(bytes) + 63 & ~63, again = free.get(size);
    if (again?.length) return again.pop();
    const at = top + HEAD, missing = at + size - memory.buffer.byteLength;
    if (missing > 0) grow(missing);
    top = at + size;
    words[at - HEAD >> 2] = size;
    return at;
  }
  function give(at) {
    const size = words[at - HEAD >> 2], same = free.get(size);
    if (same) same.push(at); else free.set(size, [at]);
  }
  function grow(bytes) {
    memory.grow(Math.ceil(bytes / 65536));
    words = new Uint32Array(memory.buffer);
  }
  const given = {
    NRT_MemInfo_alloc_aligned(bytes) {
      const at = take(Number(bytes) + HEAD);
      words[at >> 2] = 1;  // one user, in 64 bits
      words[at + 4 >> 2] = 0;
      words[at + 16 >> 2] = at + HEAD;
      return at;
    },
    NRT_MemInfo_call_dtor: give, NRT_Allocate: take, NRT_Free: give,
    exp: Math.exp, log1p: Math.log1p, hypot: Math.hypot, sin: Math.sin, tan: Math.tan, acos: Math.acos,
  };
  const module = await WebAssembly.compile(code);
  const env = {};
  for (const {name} of WebAssembly.Module.imports(module))
    env[name] = given[name] ?? (() => { throw new Error(`planners.wasm asked for ${name}, which the page hasn't`); });
  const {exports} = await WebAssembly.instantiate(module, {env});
  memory = exports.memory;
  words = new Uint32Array(memory.buffer);
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
  const planners = {numbers, empty: (kind, ...shape) => new Numbers(kind, ...shape), used: () => top, answers: facts.answers};
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
