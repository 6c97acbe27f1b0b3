// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/body_channel.h>

namespace tetskin::bullet_detail {

/// No other library attaches companions to bodies.
BodyChannel& BodyChannel::of(BodyWithTrees& body) {
  if (!body.companion()) body.setCompanion(std::make_unique<BodyChannel>());
  return static_cast<BodyChannel&>(*body.companion());
}

void BodyChannel::dropStep() {
  setSpeculation(0);
  pointContacts_.clear();
}

void BodyChannel::returnToStart() {
  if (surfaceContacts_.expired()) setReach(-1);
  dropStep();
}

void BodyChannel::serialize(WorldStream& stream) {
  stream(reach_);
}

BodyChannel* channelOf(const btSoftBody& body) {
  const BodyWithTrees* own = bodyWithTrees(body);
  return own ? static_cast<BodyChannel*>(own->companion()) : nullptr;
}

}  // namespace tetskin::bullet_detail
