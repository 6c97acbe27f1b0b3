// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which names a shared library shows. All else is hidden: a class or function without its library's mark can be used
// inside of that library alone. Only where a DLL is used or made do the marks differ: TETSKIN_SHARED is defined for all
// users of shared libraries, and TETSKIN_MAKES_<LIBRARY> while that one is compiled.
#pragma once

#if defined(_WIN32) && defined(TETSKIN_SHARED)
#define TETSKIN_EXPORTED __declspec(dllexport)
#define TETSKIN_IMPORTED __declspec(dllimport)
#elif defined(__GNUC__)
#define TETSKIN_EXPORTED __attribute__((visibility("default")))
#define TETSKIN_IMPORTED TETSKIN_EXPORTED
#else
#define TETSKIN_EXPORTED
#define TETSKIN_IMPORTED
#endif

#ifdef TETSKIN_MAKES_CORE
#define TETSKIN_CORE_API TETSKIN_EXPORTED
#else
#define TETSKIN_CORE_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_BULLET
#define TETSKIN_BULLET_API TETSKIN_EXPORTED
#else
#define TETSKIN_BULLET_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_CAGE
#define TETSKIN_CAGE_API TETSKIN_EXPORTED
#else
#define TETSKIN_CAGE_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_CONTACT
#define TETSKIN_CONTACT_API TETSKIN_EXPORTED
#else
#define TETSKIN_CONTACT_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_ELASTIC
#define TETSKIN_ELASTIC_API TETSKIN_EXPORTED
#else
#define TETSKIN_ELASTIC_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_IO
#define TETSKIN_IO_API TETSKIN_EXPORTED
#else
#define TETSKIN_IO_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_REDUCED
#define TETSKIN_REDUCED_API TETSKIN_EXPORTED
#else
#define TETSKIN_REDUCED_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_REPLAY
#define TETSKIN_REPLAY_API TETSKIN_EXPORTED
#else
#define TETSKIN_REPLAY_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_SOLVER
#define TETSKIN_SOLVER_API TETSKIN_EXPORTED
#else
#define TETSKIN_SOLVER_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_THREADS
#define TETSKIN_THREADS_API TETSKIN_EXPORTED
#else
#define TETSKIN_THREADS_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_TOUCH
#define TETSKIN_TOUCH_API TETSKIN_EXPORTED
#else
#define TETSKIN_TOUCH_API TETSKIN_IMPORTED
#endif
#ifdef TETSKIN_MAKES_WORLD
#define TETSKIN_WORLD_API TETSKIN_EXPORTED
#else
#define TETSKIN_WORLD_API TETSKIN_IMPORTED
#endif
