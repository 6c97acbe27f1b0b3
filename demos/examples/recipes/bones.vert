// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Draws a mesh by the bones of a BonePalette (layout Rows). Prepend "#version 330 core" or "#version 300 es", and
// "#define GRADIENTS" if the palette was made with PaletteOptions::gradients.

precision highp float;
precision highp int;

in vec3 restPosition;
in vec3 restNormal;
in uvec4 bones;    // SkinnedMesh::bones
in vec4 weights;   // SkinnedMesh::weights, or normalisedWeights()

uniform highp sampler2D palette;  // 3 x boneCount texels of RGBA32F: the rows of each bone
uniform mat4 viewProjection;      // of world space minus the palette's origin

out vec3 position;
out vec3 normal;

void main() {
  vec4 x = vec4(0.0), y = vec4(0.0), z = vec4(0.0);  // rows of the blended bone
  for (int k = 0; k < 4; ++k) {
    int bone = int(bones[k]);
    x += weights[k] * texelFetch(palette, ivec2(0, bone), 0);
    y += weights[k] * texelFetch(palette, ivec2(1, bone), 0);
    z += weights[k] * texelFetch(palette, ivec2(2, bone), 0);
  }
#ifdef GRADIENTS
  position = restPosition + vec3(x.w, y.w, z.w);
#else
  vec4 rest = vec4(restPosition, 1.0);
  position = vec3(dot(x, rest), dot(y, rest), dot(z, rest));
#endif
  // The cofactors: the inverse transpose without its division, and the right side out where a tet is inverted.
  normal = normalize(vec3(dot(cross(y.xyz, z.xyz), restNormal), dot(cross(z.xyz, x.xyz), restNormal),
                          dot(cross(x.xyz, y.xyz), restNormal)));
  gl_Position = viewProjection * vec4(position, 1.0);
}
