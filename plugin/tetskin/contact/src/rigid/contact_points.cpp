// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/contact_points.h>

namespace tetskin {

void addContactPoints(const BodyContacts& contacts, std::vector<SurfaceContactPoint>& points) {
  for (const PointContact& contact : contacts.body().pointContacts()) {
    if (!contact.object) continue;
    points.push_back({contact.position, contact.normal, contact.distance, contact.object, contact.impulse});
  }
}

}  // namespace tetskin
