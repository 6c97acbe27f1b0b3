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
#include "report/solver.h"
#include "report/surface_errors.h"
#include "report/xpbd_fit.h"
#include "scenes/table.h"

namespace tetskin::report {

/// The work on one cage in one scene.
struct Job {
  std::size_t tets = 0;
  CageKind kind = CageKind::Same;
  std::vector<SurfaceKind> surfaces;  ///< none: a reference
  std::vector<int> substeps;          ///< per frame; all surfaces for the first, one for the others; 0: the material's
  bool coloured = false;              ///< also colour a mesh by the errors of the first
  bool bullets = false;               ///< a reference with Bullet's forces, in addition to ours
  int modes = 0;                      ///< not 0: a reduced body with this many of the reference's modes
  bool solvers = false;               ///< all solvers in all their substeps, instead of `substeps`
};

/// The mesh of the report.
struct ReportModel {
  std::string name;
  TriangleMesh mesh;            ///< of kSize, centred at the origin
  double diagonal = 0.0;        ///< diagonal of the mesh's box
  double modelDiagonal = 0.0;   ///< the same diagonal in the unit of the mesh's file
  scenes::Placement placement;  ///< from the space of the mesh's file
  ReferenceSource reference;
};

/// How a coarse cage moves, and how the reference does: node positions by frame.
struct ShownMotion {
  const Cage& cage;
  Trajectory nodes;
  const Cage& right;
  const Trajectory& rightNodes;
  TriangleMesh obstacles;
};

/// The scene in which nothing is simulated, as a control.
constexpr const char* kExact = "exact";

/// Measures the cages of one scene.
class SceneRunner {
 public:
  /// All arguments must outlive this object.
  SceneRunner(const ReportModel& model, CageShelf& cages, ReferenceShelf& references, const ReportOptions& options,
              const std::string& scene);

  const std::string& scene() const { return entry_.name; }
  std::string integrator() const;
  /// The jobs: the reference first (there is none in the exact scene), then the cages, coarsest first.
  const std::vector<Job>& jobs() const { return jobs_; }
  /// A relative measure of the time that a job takes.
  double costOf(const Job& job) const;

  /// progress  called with the finished share of the job, from 0 to 1
  std::vector<Row> run(const Job& job, const std::function<void(double)>& progress);
  /// The coloured mesh of the job that makes one, after its rows are made.
  const std::optional<std::string>& colouredMesh() const { return coloured_; }
  /// The motion of that job, simulated again; not available for the exact scene. Valid as long as this object.
  ShownMotion shownMotion();
  /// The surface of the mesh in the reference.
  const Points& rightSurface(int frame) { return reference().surfaceAt(frame).positions; }

 private:
  /// The motion of a cage with some number of substeps, with the data that is known before surfaces are compared.
  struct Motion {
    int substeps;  ///< as the job names them
    Row row;
    Trajectory nodes;
    SurfaceCosts costs;
  };

  bool isExact() const { return entry_.name == kExact; }
  bool isReference(const Job& job) const { return job.surfaces.empty(); }
  /// A reference, and the material of everything that is compared with it.
  struct Right {
    std::optional<scenes::SceneOptions> material;
    Trajectory trajectory;
    std::unique_ptr<Reference> reference;
  };

  const Job* referenceJob(bool bullets) const;
  const Job* colouredJob() const;
  const scenes::SceneOptions& material(bool bullets = false);
  Reference& reference(bool bullets = false);
  int referenceSubsteps(const Job& job) const;
  scenes::SceneOptions optionsOf(const Job& job, const Cage& cage, int substeps);
  Motion move(const Job& job, const ShelvedCage& shelved, int substeps, const Trajectory& driven,
              const FrameDone& done);
  /// The motion of a job's cage in the reference's substeps; its usual one where these are the same.
  Trajectory convergedMotion(const Job& job, const Cage& cage, const Trajectory& usual);
  /// A solver in some substeps, with the constants that suit it best.
  struct Setting {
    Solver solver;
    scenes::SceneOptions options;
    XpbdConstants constants;
  };
  std::vector<Setting> settingsOf(const Job& job, const Cage& cage);
  Simulation simulated(const Setting& setting, const Cage& cage, const XpbdModel& model) const;
  /// Chooses damping, and XPBD's constants, for the least error.
  void choose(Setting& setting, const Cage& cage, const XpbdModel& model, const SampledErrors& errors);
  std::vector<Row> solverRows(const Job& job, const std::function<void(double)>& progress);
  /// A row without its errors in space and in time, and of the embedding.
  Row compared(const Job& job, const Cage& cage, SurfaceKind kind, const Motion& motion);
  /// Simulates the reference's cage, and keeps its motion in `trajectory`.
  Row referenceRow(const Job& job, const scenes::SceneOptions& options, const FrameDone& done, Trajectory& trajectory);
  /// The reference's own row, behind one of the same cage in the usual substeps if these are fewer.
  std::vector<Row> referenceRows(const Job& job, const std::function<void(double)>& progress);
  /// Adds the reference's own error, estimated by coarser cages of its kind, all with few substeps: errors in time are
  /// nearly the same in all of them.
  /// motion  of the reference with these options
  void estimateOwnErrors(const Job& job, const scenes::SceneOptions& options, const Trajectory& motion,
                         const FrameDone& done, Row& row);
  ReferenceTets referenceTets(bool bullets) const;
  const Cage& referenceCage(bool bullets = false) { return references_.at(referenceTets(bullets)).cage; }
  Row rowOf(const Job& job, const ShelvedCage& shelved) const;
  void colour(const SurfaceErrors& errors, int frame);

  const ReportModel& model_;
  CageShelf& cages_;
  ReferenceShelf& references_;
  const ReportOptions& options_;
  const scenes::SceneEntry& entry_;
  int frames_;
  ModeShelf modes_;
  std::vector<Job> jobs_;
  std::optional<std::string> coloured_;
  Right right_[2];  ///< with the library's elasticity; with Bullet's
};

}  // namespace tetskin::report
