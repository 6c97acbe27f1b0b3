// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <tetskin/touch/src/points/body_kind.h>

namespace tetskin::touch_detail {

bool isReduced(const btSoftBody& body) {
  return dynamic_cast<const btReducedDeformableBody*>(&body) != nullptr;
}

}  // namespace tetskin::touch_detail
