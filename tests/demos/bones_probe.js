// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Has three.js draw models by their bones, and leaves in the document what its shader computes. Each vertex is a triangle
// that covers one pixel, whose colour is the result.
'use strict';

/** Each vertex three times. */
function thrice(values, components, Kind = Float32Array) {
  const out = new Kind(3 * values.length);
  for (let v = 0; v < values.length / components; ++v) {
    const one = values.slice(components * v, components * (v + 1));
    for (let corner = 0; corner < 3; ++corner) out.set(one, components * (3 * v + corner));
  }
  return out;
}

/** Corners of a triangle around each pixel's centre, on a square of `side` pixels, from -1 to 1. */
function cornersOf(count, side) {
  const corners = [];
  for (let v = 0; v < count; ++v) {
    const x = (v % side + 0.5) * 2 / side - 1, y = (Math.floor(v / side) + 0.5) * 2 / side - 1, r = 0.5 / side;
    corners.push(x - r, y - r, x + r, y - r, x, y + r);
  }
  return new Float32Array(corners);
}

/** What the shader computes for every vertex, three numbers each. */
function drawn(renderer, model, result) {
  const count = model.positions.length / 3, side = Math.ceil(Math.sqrt(count));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(thrice(model.positions, 3), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(thrice(model.normals, 3), 3));
  geometry.setAttribute('corner', new THREE.BufferAttribute(cornersOf(count, side), 2));
  const material = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    vertexShader: `
      #include <skinning_pars_vertex>
      attribute vec2 corner;
      varying vec3 seen;
      void main() {
        #include <beginnormal_vertex>
        #include <skinbase_vertex>
        #include <skinnormal_vertex>
        #include <begin_vertex>
        #include <skinning_vertex>
        seen = ${result};
        gl_Position = vec4(corner, 0.0, 1.0);
      }`,
    fragmentShader: 'varying vec3 seen; void main() { gl_FragColor = vec4(seen, 1.0); }'
  });
  const mesh = boneMesh(geometry, material, thrice(model.bones, 4, Uint16Array), thrice(model.weights, 4),
                        model.palette.length / 16, model.gradients);
  const target = new THREE.WebGLRenderTarget(side, side, {
    type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter
  });
  const scene = new THREE.Scene();
  scene.add(mesh);
  renderer.setRenderTarget(target);
  for (const bones of [model.palette.map(() => 0), model.palette]) {  // the second frame is seen
    mesh.setBones(bones);
    renderer.render(scene, new THREE.Camera());
  }
  const pixels = new Float32Array(4 * side * side), numbers = [];
  renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
  for (let v = 0; v < count; ++v) numbers.push(pixels[4 * v], pixels[4 * v + 1], pixels[4 * v + 2]);
  return numbers;
}

const renderer = new THREE.WebGLRenderer(), report = document.createElement('pre');
report.id = 'report';
report.textContent = JSON.stringify(MODELS.map(model => ({
  positions: drawn(renderer, model, 'transformed'),
  normals: drawn(renderer, model, 'normalize(objectNormal)')
})));
document.body.append(report);
