// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report_row.h"

#include <nlohmann/json.hpp>

namespace tetskin::report {

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"tets", &Row::tets},
      {"nodes", &Row::nodes},
      {"edge", &Row::edge},
      {"copies", &Row::copies},
      {"substeps", &Row::substeps},
      {"stiffness_factor", &Row::stiffnessFactor},
      {"calibration_left", &Row::calibrationLeft},
      {"error_total_rms", &Row::errorTotalRms},
      {"error_of_motion", &Row::errorOfMotion},
      {"error_against_bullet_rms", &Row::errorAgainstBullet},
      {"error_total_max", &Row::errorTotalMax},
      {"error_space_rms", &Row::errorSpaceRms},
      {"error_time_rms", &Row::errorTimeRms},
      {"error_embedding_rms", &Row::errorEmbeddingRms},
      {"error_simulation_rms", &Row::errorSimulationRms},
      {"normal_error_mean_deg", &Row::normalErrorMeanDeg},
      {"resolved", &Row::resolved},
      {"simulation_ms", &Row::simulationMs},
      {"skin_us", &Row::skinUs},
      {"total_ms", &Row::totalMs},
      {"attach_ms", &Row::attachMs},
      {"calibrate_ms", &Row::calibrateMs},
      {"damping_ms", &Row::dampingMs},
      {"xpbd_stiffness", &Row::xpbdStiffness},
      {"xpbd_volume_stiffness", &Row::xpbdVolume},
      {"modes", &Row::modes},
      {"modes_left_out", &Row::modesLeftOut},
      {"modes_ms", &Row::modesMs},
      {"projection_error", &Row::projectionError},
      {"speedup", &Row::speedup},
      {"speedup_against_bullet", &Row::speedupAgainstBullet},
      {"memory_bytes", &Row::memoryBytes},
      {"frames", &Row::frames},
      {"finite", &Row::finite},
      {"box_diagonal_which_is_the_unit_of_errors_and_edge", &Row::diagonal},
  };
  return all;
}

nlohmann::ordered_json toJson(const Row& row) {
  nlohmann::ordered_json json;
  json["scene"] = row.scene;
  json["integrator"] = row.integrator;
  json["material"] = row.material;
  json["interpolation"] = row.interpolation;
  for (const Column& column : columns()) json[column.name] = row.*column.value;
  json["pareto"] = row.pareto;
  json["error_total_rms_by_frame"] = row.errorByFrame;
  json["amplitude_rms_by_frame"] = row.amplitudeByFrame;
  return json;
}

}  // namespace tetskin::report
