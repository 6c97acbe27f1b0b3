// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/exported/point_search.h>
#include <tetskin/solver/src/search/contact_algorithm.h>

#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

/// Removes the body's pairs, so that the next step creates them and their algorithms anew.
void forgetPairs(btSoftBody& body, btDeformableMultiBodyDynamicsWorld& world) {
  if (btBroadphaseProxy* proxy = body.getBroadphaseHandle()) {
    world.getPairCache()->cleanProxyFromPairs(proxy, world.getDispatcher());
  }
}

}  // namespace

PointSearch::PointSearch(btDeformableMultiBodyDynamicsWorld& world, BodyWithTrees& body, ContactPatches patches,
                         const SearchDistances& distances)
    : contacts_(std::make_shared<BodyContacts>(
          world.getDispatcher(), body, PointCollider(std::move(patches), distances.slack), distances.thickness)),
      marginBefore_(body.margin()) {
  assert(!(distances.margin < 0) && !(distances.beyondNodes < 0));
  registerContactAlgorithms(static_cast<btCollisionDispatcher&>(*world.getDispatcher()));
  body.getCollisionShape()->setMargin(distances.margin);
  BodyChannel& channel = BodyChannel::of(body);
  channel.setReach(distances.margin + distances.beyondNodes);
  channel.setSurfaceContacts(contacts_);
  forgetPairs(body, world);
  body.activate();
}

PointSearch::~PointSearch() {
  if (!contacts_->bodyLives()) return;
  BodyWithTrees& body = contacts_->body();
  body.getCollisionShape()->setMargin(marginBefore_);
  BodyChannel::of(body).setReach(-1);
}

bool PointSearch::exists(const btSoftBody& body) {
  const BodyChannel* channel = channelOf(body);
  return channel && !channel->surfaceContacts().expired();
}

const PointContacts* PointSearch::contacts() const {
  return contacts_->bodyLives() ? &BodyChannel::of(contacts_->body()).pointContacts() : nullptr;
}

const ContactPatches& PointSearch::patches() const {
  return contacts_->search().patches();
}

}  // namespace tetskin::bullet_detail
