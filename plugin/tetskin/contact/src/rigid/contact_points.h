// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: what is told of the contacts of a step.
#pragma once

#include <tetskin/contact/src/rigid/body_contacts.h>
#include <tetskin/contact/surface_contact.h>

#include <vector>

namespace tetskin {

/// One for each point and object. The body must live.
void addContactPoints(const BodyContacts& contacts, std::vector<SurfaceContactPoint>& points);

}  // namespace tetskin
