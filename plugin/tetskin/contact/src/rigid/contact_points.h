// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the report of the contacts of a step.
#pragma once

#include <tetskin/contact/src/rigid/body_contacts.h>
#include <tetskin/contact/surface_contact.h>

#include <vector>

namespace tetskin {

/// Appends one entry for each point and object. The body must exist.
void addContactPoints(const BodyContacts& contacts, std::vector<SurfaceContactPoint>& points);

}  // namespace tetskin
