// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// three.js draws a mesh by the bones of a BonePalette (layout Columns).

/**
 * A mesh that follows its bones: call mesh.setBones(floats) once per frame, with 16 numbers a bone.
 * geometry    with the rest positions and normals
 * bones       Uint16Array: SkinnedMesh::bones;  weights  Float32Array: SkinnedMesh::weights
 * gradients   the palette was made with PaletteOptions::gradients
 */
function boneMesh(geometry, material, bones, weights, boneCount, gradients = false) {
  geometry.setAttribute('skinIndex', new THREE.BufferAttribute(bones, 4));
  geometry.setAttribute('skinWeight', new THREE.BufferAttribute(weights, 4));
  carryNormals(material, gradients);
  const skeleton = new THREE.Skeleton(Array.from({length: boneCount}, () => new THREE.Bone()));
  skeleton.update = () => {};  // three.js would compute its own bones
  const mesh = new THREE.SkinnedMesh(geometry, material);
  mesh.bindMode = 'detached';
  mesh.bind(skeleton, new THREE.Matrix4());
  mesh.frustumCulled = false;  // three.js knows only the box at rest
  mesh.setBones = floats => {
    skeleton.boneMatrices.set(floats);
    if (skeleton.boneTexture) skeleton.boneTexture.needsUpdate = true;
  };
  return mesh;
}

/** Normals go by the cofactors of the blended bone, where three.js takes the bone itself, which is for rotations. */
function carryNormals(material, gradients) {
  material.skinning = true;
  if (gradients) material.defines = Object.assign({GRADIENTS: ''}, material.defines);
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader.replace('#include <skinnormal_vertex>', `
      mat4 blended = skinWeight.x * boneMatX + skinWeight.y * boneMatY + skinWeight.z * boneMatZ + skinWeight.w * boneMatW;
      objectNormal = mat3(cross(blended[1].xyz, blended[2].xyz), cross(blended[2].xyz, blended[0].xyz),
                          cross(blended[0].xyz, blended[1].xyz)) * objectNormal;`);
    shader.vertexShader = shader.vertexShader.replace('#include <skinning_vertex>', `
      #ifdef GRADIENTS
      transformed += blended[3].xyz;
      #else
      #include <skinning_vertex>
      #endif`);
  };
}
