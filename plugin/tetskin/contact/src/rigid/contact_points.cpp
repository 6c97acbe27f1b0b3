// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/contact_points.h>

namespace tetskin {

void addContactPoints(const BodyContacts& contacts, std::vector<SurfaceContactPoint>& points) {
  const bool awake = contacts.body().isActive();
  for (const PointContact& contact : contacts.body().pointContacts()) {
    if (!contact.object) continue;
    const btVector3 impulse = awake ? contact.impulse : btVector3(0, 0, 0);
    points.push_back({contact.position, contact.normal, contact.distance, contact.object, impulse});
  }
}

}  // namespace tetskin
