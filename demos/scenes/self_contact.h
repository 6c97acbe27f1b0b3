// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>

#include "scenes/world.h"

namespace tetskin::scenes {

/// Whether a body has self-contact, as requested on the command line.
enum class SelfContactWish { WherePossible, On, Off };

/// By default, a body has self-contact if its surface touches other bodies.
SelfContactWish wishBeside(Contact contact, SelfContactWish wish);

/// Contact of a body with itself in a run.
struct SelfContact {
  std::shared_ptr<const ContactShape> shape;  ///< null: no contact with itself
  std::string refusal;                        ///< why there is no self-contact although it was requested; or empty

  /// The state as a word: "on", "off" or "refused".
  const char* word() const;
  /// Adds `self_contact` to a summary, and `self_contact_refusal` if it was refused.
  void tell(nlohmann::ordered_json& json) const;
};

/// Makes the shape, unless self-contact is off. If it cannot be made, throws InputError where it was requested
/// explicitly; otherwise the run does without it, and prints a line about that unless it is quiet.
/// name  of the mesh, for messages
SelfContact selfContactOf(const std::string& name, const Cage& cage, const TriangleMesh& mesh, SelfContactWish wish,
                          bool quiet);

}  // namespace tetskin::scenes
