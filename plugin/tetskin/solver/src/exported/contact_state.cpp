// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/exported/solver_state.h>
#include <tetskin/solver/src/search/body_contacts.h>

#include <memory>

namespace tetskin::bullet_detail {
namespace {

/// A body has none before its first step, for instance in a world that was newly built.
void serializeNodeContacts(WorldStream& stream, BodyWithTrees& body, BodyChannel& channel) {
  btScalar size = channel.nodeContacts() ? channel.contactSize() : btScalar(0);
  const btScalar now = size;
  stream(size);
  if (stream.restoring() && size != now) {
    channel.setNodeContacts(size > 0 ? makeNodeContacts(body, size) : nullptr, size);
  }
  if (size > 0) channel.nodeContacts()->serialize(stream);
}

}  // namespace

void serializeContactSearch(WorldStream& stream) {
  btAlignedObjectArray<btSoftBody*>& bodies = stream.world().getSoftBodyArray();
  for (int b = 0; b < bodies.size(); ++b) {
    BodyWithTrees* body = bodyWithTrees(*bodies[b]);
    if (!body) continue;
    BodyChannel& channel = BodyChannel::of(*body);
    channel.serialize(stream);
    serializeNodeContacts(stream, *body, channel);
    // `checkForces` has found that both worlds have it, or neither.
    if (const std::shared_ptr<BodyContacts> atSurface = channel.surfaceContacts().lock()) atSurface->serialize(stream);
    if (stream.failed()) return;
  }
}

}  // namespace tetskin::bullet_detail
