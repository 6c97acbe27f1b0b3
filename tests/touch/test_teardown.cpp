// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Everything in a world may be destroyed in any order, including the world and its solver; remaining objects report it.
// Faults here show under a sanitizer, or a memory checker.
#include "crowded_world.h"

namespace tetskin::test {
namespace {

/// The checks on everything that still exists.
void askAll(CrowdedWorld& of, bool hasWorld) {
  const bool hasSolver = of.world.softSolver != nullptr;
  if (of.contacts) {
    if (!hasSolver) {
      EXPECT_TRUE(of.contacts->contacts().empty());
    }
    if (of.lower->body) {
      (void)of.contacts->status(of.lower->soft());
      if (!hasSolver) {
        EXPECT_FALSE(of.contacts->add(of.lower->soft(), toyModel().shape).ok());
      }
    }
  }
  if (of.record && of.lower->body) (void)of.record->forcesOn(of.lower->soft());
  if (of.spring) (void)of.spring->status();
  if (of.weld && of.hung) (void)of.weld->separation();
  for (Toy* toy : {of.lower.get(), of.upper.get(), of.held.get()}) {
    EXPECT_EQ(toy->skin.update() == StatusCode::BodyDeleted, !toy->body);
    toy->skin.recordStep();
    toy->skin.markTeleported();
    if (toy->contact) {
      EXPECT_TRUE((toy->body && hasWorld) || toy->contact->contacts().empty());
    }
  }
}

TEST(Teardown, GoesInAnyOrder) {
  std::array<int, 11> order;
  for (int k = 0; k < 11; ++k) order[static_cast<std::size_t>(k)] = k;
  std::mt19937 random(1);
  for (int run = 0; run < 24; ++run) {
    std::shuffle(order.begin(), order.end(), random);
    CrowdedWorld of;
    // Rigid bodies are the application's own, and leave a world while it exists.
    of.box.reset();
    of.base.reset();
    step(of.world, 3);
    ASSERT_EQ(of.lower->skin.update(), StatusCode::Ok);
    const auto destroyWorld = [&] {
      of.weld.reset();  // before the object that it is attached to
      of.hung.reset();
      of.shelf.reset();
      of.world.world.reset();
    };
    const std::function<void()> parts[] = {[&] { of.contacts.reset(); },
                                           [&] { of.record.reset(); },
                                           [&] { of.spring.reset(); },
                                           [&] { of.weld.reset(); },
                                           [&] { of.lower->body.reset(); },
                                           [&] { of.upper->body.reset(); },
                                           [&] { of.held->body.reset(); },
                                           [&] { of.lower->contact.reset(); },
                                           [&] { of.upper->contact.reset(); },
                                           [&] { of.world.softSolver.reset(); },
                                           destroyWorld};
    for (const int part : order) {
      parts[part]();
      askAll(of, of.world.world != nullptr);
      if (of.world.world && of.world.softSolver) substep(of.world);
    }
    // The test's own world removes its floor from some world.
    of.world.world = std::make_unique<btDiscreteDynamicsWorld>(&of.world.dispatcher, &of.world.broadphase,
                                                               of.world.solver.get(), &of.world.configuration);
  }
}

}  // namespace
}  // namespace tetskin::test
