// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Templates that are compiled here for all scalars there are: `of` is a macro that writes one instantiation.
#pragma once

#define TETSKIN_FOR_SCALARS(of) of(float) of(double)
/// Of the nodes, and of what is written.
#define TETSKIN_FOR_SCALAR_PAIRS(of) of(float, float) of(float, double) of(double, float) of(double, double)
