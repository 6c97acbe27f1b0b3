// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Instantiates templates for all scalar types: `of` is a macro that writes one instantiation.
#pragma once

#define TETSKIN_FOR_SCALARS(of) of(float) of(double)
/// The same for a class template.
#define TETSKIN_INSTANTIATE_CLASS(name)                                             \
  template class name<float>;  /* NOLINT(bugprone-macro-parentheses): a template */ \
  template class name<double>; /* NOLINT(bugprone-macro-parentheses): a template */
/// The scalar types of the nodes and of the output.
#define TETSKIN_FOR_SCALAR_PAIRS(of) of(float, float) of(float, double) of(double, float) of(double, double)
