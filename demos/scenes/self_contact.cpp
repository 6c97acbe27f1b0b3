// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/self_contact.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/input_error.h"

namespace tetskin::scenes {

SelfContactWish wishBeside(Contact contact, SelfContactWish wish) {
  if (wish != SelfContactWish::WherePossible) return wish;
  return contact == Contact::Surface ? wish : SelfContactWish::Off;
}

const char* SelfContact::word() const {
  if (shape) return "on";
  return refusal.empty() ? "off" : "refused";
}

void SelfContact::tell(nlohmann::ordered_json& json) const {
  json["self_contact"] = word();
  if (!refusal.empty()) json["self_contact_refusal"] = refusal;
}

SelfContact selfContactOf(const std::string& name, const Cage& cage, const TriangleMesh& mesh, SelfContactWish wish,
                          bool quiet) {
  if (wish == SelfContactWish::Off) return {};
  Result<std::shared_ptr<const ContactShape>> shape = ContactShape::create(cage, mesh);
  if (shape.ok()) return {std::move(shape).value(), ""};
  const std::string refusal = name + ": " + shape.status().message;
  if (wish == SelfContactWish::On) throw InputError("--self-contact on: " + refusal);
  if (!quiet) std::printf("Self-contact is off: %s\n", refusal.c_str());
  return {nullptr, refusal};
}

}  // namespace tetskin::scenes
