// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Names that the documentation's snippets use without declaring them: objects that an application would have at that
// point. The snippets are compiled and linked, but not run.
#pragma once

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tetskin/tetskin.h>

#include <cstdio>

struct Vertex {
  float position[3], normal[3], texcoord[2];
};

inline btDeformableMultiBodyDynamicsWorld* world = nullptr;
inline btDeformableMultiBodyDynamicsWorld* reducedWorld = nullptr;  // made with a btReducedDeformableBodySolver
inline tetskin::Cage cage;
inline tetskin::TetMesh fineTets;
inline tetskin::TriangleMesh mesh;
inline std::unique_ptr<tetskin::DeformableBody> body;
inline btSoftBody* softBody = nullptr;  // a soft body of the application's
inline btRigidBody* finger = nullptr;   // a rigid body of the application's
inline tetskin::SkinOptions options;
inline tetskin::SoftBodySkin skin;
inline tetskin::Embedding embedding;
inline std::vector<tetskin::SoftBodySkin*> everybody;
inline std::vector<Vertex> vertices;
inline void uploadVertices() {}
inline btScalar unspent = 0, frameTime = btScalar(1) / 144, step = btScalar(1) / 60;  // seconds
