// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/touch/src/points/body_kind.h>

namespace tetskin::touch_detail {

bool isReduced(const btSoftBody& body) {
  return body.m_reducedModel;
}

}  // namespace tetskin::touch_detail
