// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: what is told of the contacts of a step.
#pragma once

#include <tetskin/contact/src/rigid/body_contacts.h>
#include <tetskin/contact/surface_contact.h>

#include <vector>

namespace tetskin {

/// One for each point and object: nodes that a point is held by share it, and their impulses are added up.
std::vector<SurfaceContactPoint> contactPoints(const BodyContacts& contacts);

}  // namespace tetskin
