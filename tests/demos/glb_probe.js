// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Loads a GLB, given as base64 in GLB, with three.js' own loader, shows frames as players do, and leaves in the document
// where the vertices are.
'use strict';

const FRAMES = [0, 100], FRAME_RATE = 60;

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), c => c.charCodeAt(0)).buffer;
}

/** Positions of a skinned mesh, in the world, by the formula of three.js' shader. */
function skinnedPositions(mesh) {
  const {position, skinIndex, skinWeight} = mesh.geometry.attributes, all = [];
  const bone = new THREE.Matrix4(), rest = new THREE.Vector3(), moved = new THREE.Vector3();
  for (let v = 0; v < position.count; ++v) {
    rest.fromBufferAttribute(position, v).applyMatrix4(mesh.bindMatrix);
    const sum = new THREE.Vector3();
    for (let k = 0; k < 4; ++k) {
      bone.fromArray(mesh.skeleton.boneMatrices, 16 * skinIndex.array[4 * v + k]);
      sum.addScaledVector(moved.copy(rest).applyMatrix4(bone), skinWeight.array[4 * v + k]);
    }
    sum.applyMatrix4(mesh.bindMatrixInverse).applyMatrix4(mesh.matrixWorld);
    all.push(sum.x, sum.y, sum.z);
  }
  return all;
}

/** Share of the pixels that are not background, in a view of all that is drawn. */
function drawn(scene, centre, radius) {
  const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true}), size = 128;
  renderer.setSize(size, size);
  const camera = new THREE.PerspectiveCamera(45, 1, 0.01 * radius, 100 * radius);
  camera.position.copy(centre).add(new THREE.Vector3(0, 0.5, 3).multiplyScalar(radius));
  camera.lookAt(centre);
  scene.add(new THREE.HemisphereLight());
  renderer.render(scene, camera);
  const gl = renderer.getContext(), pixels = new Uint8Array(4 * size * size);
  gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let lit = 0;
  for (let i = 0; i < pixels.length; i += 4) lit += pixels[i] + pixels[i + 1] + pixels[i + 2] > 30;
  return lit / (size * size);
}

function report(gltf) {
  const found = {}, meshes = [];
  gltf.scene.traverse(object => object.isSkinnedMesh && meshes.push(object));
  for (const mesh of meshes) mesh.frustumCulled = false;
  found.meshes = meshes.length;
  found.normals = Boolean(meshes[0].geometry.attributes.normal);
  found.texcoords = Boolean(meshes[0].geometry.attributes.uv);
  found.obstacles = Boolean(gltf.scene.getObjectByName('obstacles'));
  found.colours = new Set(meshes.map(mesh => mesh.material.color.getHex())).size;
  const mixer = new THREE.AnimationMixer(gltf.scene), action = mixer.clipAction(gltf.animations[0]);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  for (const frame of FRAMES) {
    action.time = frame / FRAME_RATE;
    mixer.update(0);
    gltf.scene.updateMatrixWorld(true);
    meshes[0].skeleton.update();
    found[`frame_${frame}`] = skinnedPositions(meshes[0]);
  }
  const points = new THREE.BufferAttribute(new Float32Array(found.frame_100), 3);
  const sphere = new THREE.Box3().setFromBufferAttribute(points).getBoundingSphere(new THREE.Sphere());
  found.drawn = drawn(gltf.scene, sphere.center, sphere.radius);
  return found;
}

function leave(text) {
  const place = document.createElement('pre');
  place.id = 'report';
  place.textContent = text;
  document.body.append(place);
}

new THREE.GLTFLoader().parse(bytesOf(GLB), '', gltf => leave(JSON.stringify(report(gltf))),
  error => leave(JSON.stringify({error: String(error)})));
