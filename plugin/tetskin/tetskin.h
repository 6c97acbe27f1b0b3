// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// All of tetskin that you link, and its version. Each library's target, and tetskin.pc, define TETSKIN_HAS_<LIBRARY>.
#pragma once

#define TETSKIN_VERSION_MAJOR 0           ///< rises when what was there changes
#define TETSKIN_VERSION_MINOR 11          ///< rises when something is added, or while major is zero, changed
#define TETSKIN_VERSION_PATCH 0           ///< rises when something is mended
#define TETSKIN_TEXT_(x) #x               ///< for the next one
#define TETSKIN_TEXT(x) TETSKIN_TEXT_(x)  ///< what x stands for, in quotes
/// "major.minor.patch"
#define TETSKIN_VERSION \
  TETSKIN_TEXT(TETSKIN_VERSION_MAJOR) "." TETSKIN_TEXT(TETSKIN_VERSION_MINOR) "." TETSKIN_TEXT(TETSKIN_VERSION_PATCH)

#include <tetskin/core/cage.h>
#include <tetskin/core/embedded_point.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/parallel_for.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>
#ifdef TETSKIN_HAS_BULLET
#include <tetskin/bullet/bullet_parallel_for.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/force_record.h>
#include <tetskin/bullet/render_nodes.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>
#endif
#ifdef TETSKIN_HAS_CAGE
#include <tetskin/cage/cage_builder.h>
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
#include <tetskin/io/embedding_file.h>
#include <tetskin/io/mesh_loader.h>
#include <tetskin/io/obj_sequence.h>
#include <tetskin/io/tet_files.h>
#endif
#ifdef TETSKIN_HAS_REDUCED
#include <tetskin/reduced/reduced_body.h>
#endif
#ifdef TETSKIN_HAS_THREADS
#include <tetskin/threads/thread_pool.h>
#endif
#ifdef TETSKIN_HAS_TOUCH
#include <tetskin/touch/surface_point.h>
#include <tetskin/touch/surface_spring.h>
#include <tetskin/touch/surface_tree.h>
#include <tetskin/touch/surface_weld.h>
#endif
