// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <memory>
#include <vector>

#include "support/odd_meshes.h"

namespace tetskin::test {

/// Sets render nodes at these points, not yet bound to anything.
inline void setRenderNodes(btSoftBody& body, const std::vector<Eigen::Vector3d>& points) {
  body.m_renderNodes.resize(0);
  for (const Eigen::Vector3d& p : points) {
    btSoftBody::RenderNode node;
    node.m_x = toBullet(p);
    node.m_uv1.setZero();
    node.m_normal.setZero();
    body.m_renderNodes.push_back(node);
  }
}

}  // namespace tetskin::test
