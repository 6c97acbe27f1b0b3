// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the documentation's snippets speak of without declaring it: what an application would have by then. They are
// compiled and linked, not run.
#pragma once

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tetskin/tetskin.h>

#include <cstdio>

struct Vertex {
  float position[3], normal[3], texcoord[2];
};

inline btDeformableMultiBodyDynamicsWorld* world = nullptr;
inline btDeformableMultiBodyDynamicsWorld* reducedWorld = nullptr;  // made with a btReducedDeformableBodySolver
inline tetskin::TetMesh cage;
inline tetskin::TetMesh fineTets;
inline tetskin::TriangleMesh mesh;
inline std::unique_ptr<tetskin::DeformableBody> body;
inline btSoftBody* softBody = nullptr;  // the application's own
inline btRigidBody* finger = nullptr;   // likewise
inline tetskin::SkinOptions options;
inline tetskin::SoftBodySkin skin;
inline tetskin::Embedding embedding;
inline std::vector<tetskin::SoftBodySkin*> everybody;
inline std::vector<Vertex> vertices;
inline btScalar unspent = 0, frameTime = btScalar(1) / 144, step = btScalar(1) / 60;  // seconds
