// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Includes the headers of all tetskin libraries that you link, and defines the version. Each library's target, and
// tetskin.pc, define TETSKIN_HAS_<LIBRARY>. Where to begin:
//
//   a mesh on the btSoftBody that you have    bullet/soft_body_skin.h: SoftBodySkin
//   a mesh, and no body                       cage/create_cage.h: createCage; world/world.h: World, which owns them all
//   a body in a world of yours                solver/deformable_body.h: DeformableBody, with a DeformableSolver
//   go back in time, record, play             replay/snapshot.h, replay/recorder.h
//   no Bullet                                 core/mesh_skin.h: MeshSkin; elastic/elastic_body.h: ElasticBody
#pragma once

#define TETSKIN_VERSION_MAJOR 0           ///< rises with incompatible changes
#define TETSKIN_VERSION_MINOR 25          ///< rises with additions and, while major is 0, with incompatible changes
#define TETSKIN_VERSION_PATCH 0           ///< rises with fixes
#define TETSKIN_TEXT_(x) #x               ///< helper of TETSKIN_TEXT
#define TETSKIN_TEXT(x) TETSKIN_TEXT_(x)  ///< the expansion of x, as a string literal
/// "major.minor.patch"
#define TETSKIN_VERSION \
  TETSKIN_TEXT(TETSKIN_VERSION_MAJOR) "." TETSKIN_TEXT(TETSKIN_VERSION_MINOR) "." TETSKIN_TEXT(TETSKIN_VERSION_PATCH)

#include <tetskin/core/bone_palette.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/types.h>
#ifdef TETSKIN_HAS_BULLET
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>
#endif
#ifdef TETSKIN_HAS_CAGE
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#endif
#ifdef TETSKIN_HAS_CONTACT
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#endif
#ifdef TETSKIN_HAS_ELASTIC
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/elastic/vibration_modes.h>
#endif
#ifdef TETSKIN_HAS_IO
#include <tetskin/io/animation.h>
#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>
#endif
#ifdef TETSKIN_HAS_REDUCED
#include <tetskin/reduced/reduced_body.h>
#endif
#ifdef TETSKIN_HAS_REPLAY
#include <tetskin/replay/recorder.h>
#include <tetskin/replay/snapshot.h>
#endif
#ifdef TETSKIN_HAS_SOLVER
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>
#endif
#ifdef TETSKIN_HAS_THREADS
#include <tetskin/threads/thread_pool.h>
#endif
#ifdef TETSKIN_HAS_TOUCH
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>
#endif
#ifdef TETSKIN_HAS_WORLD
#include <tetskin/world/world.h>
#endif
