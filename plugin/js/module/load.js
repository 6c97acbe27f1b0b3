// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

/** The bytes of kWebAssembly, which is deflated and in base64. */
async function bytesOfModule() {
  const packed = Uint8Array.from(atob(kWebAssembly), letter => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

let compiled = null;  // a promise of the module, for all instances

async function compile() {
  if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function") throw new TypeError("too old");
  return WebAssembly.compile(await bytesOfModule());
}

async function load() {
  compiled ??= compile();
  let module;
  try {
    module = await compiled;
  } catch (error) {
    compiled = null;
    throw new TetskinError("Unsupported", "this browser cannot run tetskin, which needs WebAssembly with SIMD and " +
      `exceptions: Chrome 95, Firefox 113, Safari 16.4, Node 18, or later (${error.message})`);
  }
  const core = await new Promise((resolve, reject) => {
    createCore({
      makeError: errorOf,
      instantiateWasm(imports, receive) {
        WebAssembly.instantiate(module, imports).then(receive, reject);
        return {};
      },
    }).then(resolve, reject);
  });
  return new Tetskin(core);
}
