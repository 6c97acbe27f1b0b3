// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/cage_shelf.h"
#include "report/material.h"
#include "report/mode_shelf.h"
#include "report/reference.h"
#include "report/reference_cage.h"
#include "report/report_options.h"
#include "report/report_row.h"
#include "report/result_store.h"
#include "report/surface_errors.h"
#include "scenes/table.h"

namespace tetskin::report {

/// What is done with one cage in one scene.
struct Job {
  std::size_t tets = 0;
  CageKind kind = CageKind::Same;
  std::vector<SurfaceKind> surfaces;  ///< none: a reference
  bool coloured = false;              ///< also colour a mesh by the errors
  bool bullets = false;               ///< a reference by Bullet's forces, beside ours
  int modes = 0;                      ///< not 0: a reduced body of so many of the reference's vibrations
};

/// The mesh of the report.
struct ReportModel {
  std::string name;
  TriangleMesh mesh;           ///< of kSize, centred at the origin
  double diagonal = 0.0;       ///< of its box
  double modelDiagonal = 0.0;  ///< the same, in the unit of its file
  std::uint64_t hash = 0;
  ReferenceCage reference;
};

/// How a coarse cage moves, and how the reference does: node positions by frame.
struct ShownMotion {
  const Cage& cage;
  Trajectory nodes;
  const Cage& right;
  const Trajectory& rightNodes;
  TriangleMesh obstacles;
};

/// The control, in which nothing is simulated.
constexpr const char* kExact = "exact";

/// Measures the cages of one scene with one integrator, or takes what an earlier run had measured.
class SceneRunner {
 public:
  /// All outlive this object.
  SceneRunner(const ReportModel& model, CageShelf& cages, const ResultStore& store, const ReportOptions& options,
              const std::string& scene, Elasticity elasticity);

  const std::string& scene() const { return entry_.name; }
  std::string integrator() const;
  /// The reference first (there is none in the exact scene), then the cages, coarsest first.
  const std::vector<Job>& jobs() const { return jobs_; }
  /// Some measure of the time that a job takes.
  double costOf(const Job& job) const;

  /// The rows of a job, if an earlier run has left them.
  std::optional<std::vector<Row>> stored(const Job& job) const;
  /// share  told how much of the job is done, from 0 to 1
  std::vector<Row> run(const Job& job, const std::function<void(double)>& share);
  /// The coloured mesh of the job that makes one; after its rows.
  std::optional<std::string> colouredMesh() const;
  /// Of the same job, simulated again; not of the exact scene. Valid as long as this object.
  ShownMotion shownMotion();
  /// The mesh in the reference.
  const Points& rightSurface(int frame) { return reference().surfaceAt(frame).positions; }

 private:
  /// Of a cage, as it is and as the reference would take it, with what is known of it before surfaces are compared.
  struct Motion {
    Row row;
    Trajectory nodes, driven;
    SurfaceCosts costs;
  };

  bool isExact() const { return entry_.name == kExact; }
  bool isReference(const Job& job) const { return job.surfaces.empty(); }
  nlohmann::ordered_json settings(const Job& job) const;
  /// Of a reference, and of all that it counts as right for.
  struct Right {
    std::optional<scenes::SceneOptions> material;
    Trajectory trajectory;
    std::unique_ptr<Reference> reference;
  };

  const Job* referenceJob(bool bullets) const;
  const Job* colouredJob() const;
  const scenes::SceneOptions& material(bool bullets = false);
  Reference& reference(bool bullets = false);
  scenes::SceneOptions optionsOf(const Job& job, const Cage& cage);
  Motion move(const Job& job, const ShelvedCage& shelved, const std::function<void(double)>& share);
  std::vector<Row> referenceRows(const Job& job, const std::function<void(double)>& share);
  Row rowOf(const Job& job, const ShelvedCage& shelved) const;
  void colour(const Job& job, const SurfaceErrors& errors, int frame);

  const ReportModel& model_;
  CageShelf& cages_;
  const ResultStore& store_;
  const ReportOptions& options_;
  const scenes::SceneEntry& entry_;
  int frames_;
  ModeShelf modes_;
  Elasticity elasticity_;
  std::vector<Job> jobs_;
  Right right_[2];  ///< by the elasticity of the cages; by Bullet's, if that is another one
};

}  // namespace tetskin::report
