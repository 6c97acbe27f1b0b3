// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene of the live page as text, and its meshes, for native.cpp. Evaluated where the page's scripts are: in its
// worker, or in Node.

/** name: of SCENES, without a script; settings: those of a Simulation */
function describeScene(name, settings) {
  const lines = [], names = new Set(), noTurn = [0, 0, 0, 1], origin = [0, 0, 0];
  const rigid = (kind, size, {mass = 0, position = origin, rotation = noTurn, friction = 0.5}) =>
    lines.push([kind, ...size, mass, ...position, ...rotation, friction].join(' '));
  SCENES[name].build({
    settings,
    stiffness: settings.stiffness,
    tets: usual => settings.tets || usual,
    addBox: (halfExtents, options) => rigid('box', halfExtents, options),
    addSphere: (radius, options) => rigid('sphere', [radius], options),
    addBody(mesh, tets, {position = origin, rotation = noTurn, mass, relativeStiffness = settings.stiffness, damping = 1,
                         friction = 0.5, softContact, selfContact}) {
      names.add(mesh);
      lines.push(['body', mesh, tets, ...position, ...rotation, mass, relativeStiffness, damping * settings.damping, friction,
                  selfContact ? 'self' : softContact ? 'soft' : 'none'].join(' '));
    },
    beforeFrame() { throw new Error(`${name} has a script`); },
  });
  const meshes = {};
  for (const mesh of names) {
    const {positions, triangles} = shelf.mesh(mesh).mesh;
    meshes[mesh] = {positions: [...positions], triangles: [...triangles]};
  }
  return {lines, meshes};
}
