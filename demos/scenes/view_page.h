// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The pages of the demos. The parts of a page are in demos/view, which the Python package also contains.
#pragma once

#include <string>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/model.h"
#include "view/view_page.h"

namespace tetskin::scenes {

using view::ViewBody;
using view::ViewMoment;
using view::ViewPage;
using view::withCommas;

/// Why no page can be made, in a sentence; empty if one can be made. Pages contain three.js, which must have been found
/// when the demos were configured, and must still be there.
std::string whyNoView();
/// Throws InputError if no page can be made.
void requireViewable();
/// The file of a run's page, empty for none. If a default page cannot be made, prints why. Throws InputError where a
/// page that was requested cannot be made.
std::string viewPath(const OutputOptions& options);

/// The files that pages are made from.
view::ViewFiles viewFiles();
/// A page without bodies yet, in the materials of the demos.
ViewPage newPage(std::string title, std::vector<std::string> facts, Interpolation interpolation);
/// Writes the page, and prints its path, its size, and how to look at it. Throws an exception that names the file.
void writePage(const ViewPage& page, const std::string& path, bool quiet);

/// A model's name: that of its file, without the folder.
std::string titleOf(const std::string& name);
/// A sentence on which parts of the body touch obstacles and other bodies.
std::string factOf(Contact contact, bool withItself);
/// Numbers of vertices, triangles and tets.
std::vector<std::string> factsOf(const Model& model);

}  // namespace tetskin::scenes
