// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>

#include "scenes/world.h"

namespace tetskin::scenes {

/// Whether a body meets itself, as the command line has it.
enum class SelfContactWish { WherePossible, On, Off };

/// Where nothing is said, a body meets itself if its surface meets others.
SelfContactWish wishBeside(Contact contact, SelfContactWish wish);

/// Contact of a body with itself, as a run has it.
struct SelfContact {
  std::shared_ptr<const ContactShape> shape;  ///< null: none
  std::string refusal;                        ///< why there is none where there should be; or empty

  /// "on", "off" or "refused".
  const char* word() const;
  /// Of a summary: `self_contact`, and with a refusal `self_contact_refusal`.
  void tell(nlohmann::ordered_json& json) const;
};

/// Makes the shape, unless it is off. What cannot be made is refused where it was asked for, by an InputError, and else
/// done without, which is said in a line unless that is to be quiet.
/// name  of the mesh, for what is said
SelfContact selfContactOf(const std::string& name, const Cage& cage, const TriangleMesh& mesh, SelfContactWish wish,
                          bool quiet);

}  // namespace tetskin::scenes
