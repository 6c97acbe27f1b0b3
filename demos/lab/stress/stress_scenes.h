// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/elastic_law.h>

#include "measure/run.h"

namespace tetskin::stress {

/// Stiff and extreme cases, which check whether the simulation stays bounded, and whether the skin keeps its promises.
/// Those of Bullet's forces are for Kind::Bullet alone, all others for Kind::Surface.
/// changing  only those of the library's force, with bodies that have grown and yield, which need not recover
/// law       of bodies of the library's force; with another than the corotated one, these alone
measure::MeasuredScenes stressScenes(bool changing, const ElasticLaw& law);

}  // namespace tetskin::stress
