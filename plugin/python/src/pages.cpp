// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pages that show worlds, by the writer of demos/view. tetskin/page.py provides the files that pages are made from, and
// handles notebooks.
#include "handles.h"
#include "shape_meshes.h"

#include <algorithm>
#include <map>

#include "view/view_page.h"

namespace tetskin::python {
namespace {

using view::ViewMaterial;
using view::ViewMoment;
using view::ViewPage;

/// Colours of bodies and moving objects, in turn; of fixed objects; of a ground.
const std::vector<ViewMaterial> kMaterials = {
    {"soft 0", {0.10, 0.44, 0.27}, 0.25},    {"soft 1", {0.86, 0.50, 0.22}, 0.25},
    {"soft 2", {0.24, 0.41, 0.66}, 0.25},    {"soft 3", {0.80, 0.33, 0.38}, 0.25},
    {"soft 4", {0.52, 0.40, 0.66}, 0.25},    {"soft 5", {0.78, 0.65, 0.26}, 0.25},
    {"moving", {0.47, 0.50, 0.56}, 0.3},     {"fixed", {0.66, 0.74, 0.84}, 0.0},
    {"wall", {0.66, 0.72, 0.78}, 0.0, 0.22}, {"floor", {0.957, 0.949, 0.933}, 0.0},
};
constexpr std::size_t kSoftColours = 6;
/// Distance from the middle of the scene at which planes end, in sizes of the scene: a ground where it has faded out,
/// other planes sooner.
constexpr double kGroundReach = 12.0, kWallReach = 1.0;
/// Cosine of the steepest ground.
constexpr double kLevel = 0.9999;

TriangleMesh oneGroup(TriangleMesh mesh, const std::string& material) {
  mesh.groups = {{material, material, 0, mesh.triangleCount()}};
  return mesh;
}

void append(const TriangleMesh& added, TriangleMesh& mesh) {
  const auto shift = static_cast<int>(mesh.vertexCount());
  const std::size_t first = mesh.triangleCount();
  mesh.positions.insert(mesh.positions.end(), added.positions.begin(), added.positions.end());
  for (auto triangle : added.triangles) {
    for (int& v : triangle) v += shift;
    mesh.triangles.push_back(triangle);
  }
  for (TriangleGroup group : added.groups) {
    group.firstTriangle += first;
    mesh.groups.push_back(group);
  }
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Affine3d& place) {
  for (Eigen::Vector3d& p : mesh.positions) p = place * p;
  return mesh;
}

/// A body's name in facts: "2 bodies", "1 body".
std::string fact(std::size_t count, const char* one, const char* many) {
  return view::withCommas(count) + " " + (count == 1 ? one : many);
}

/// A run of a world, or its current state, for one page. The first frame decides what is shown.
class PageWriter {
 public:
  PageWriter(std::shared_ptr<World> world, const std::optional<BodyHandle>& only, double rate, std::string title)
      : world_(std::move(world)), title_(std::move(title)), rate_(rate) {
    if (!(rate > 0.0 && rate < 1e6)) throw nb::value_error("frames_per_second: must be above 0, and finite");
    if (only) bodies_ = {*only};
    whole_ = !only;
  }

  void addFrame() {
    const Locked lock(*world_);
    if (frameCount_ == 0) begin();
    ViewMoment moment;
    Box3 box;
    for (const BodyHandle& body : bodies_) {
      moment.bodies.push_back(nodesOf(body));
      box.extend(boundingBox(moment.bodies.back()));
    }
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      moment.props.push_back(placeOf(moving_[i]));
      box.extend(moment.props.back() * movingBoxes_[i].center());
      for (int corner = 0; corner < 8; ++corner)
        box.extend(moment.props.back() * movingBoxes_[i].corner(static_cast<Box3::CornerType>(corner)));
    }
    page_->keep(moment);
    box_.extend(box);
    ++frameCount_;
  }

  std::string html(const std::string& folder) {
    if (frameCount_ == 0) fail(StatusCode::Empty, "no frame has been added: call add_frame() first");
    const Locked lock(*world_);
    // Neither empty nor flat, because of the camera.
    Box3 focus = box_;
    if (focus.isEmpty()) focus = fixedBox_;
    if (focus.isEmpty()) focus.extend(Eigen::Vector3d::Zero());
    const double size = std::max(focus.sizes().norm(), 1e-6);
    if (!(focus.sizes().norm() > 1e-6)) focus = Box3(focus.center().array() - 1.0, focus.center().array() + 1.0);
    page_->setFocus(focus);
    TriangleMesh obstacles = fixed_;
    for (const Eigen::Hyperplane<double, 3>& plane : planes_) append(planeMesh(plane, focus.center(), size), obstacles);
    page_->setObstacles(obstacles);
    try {
      return page_->html({folder, folder + "/three.min.js", folder + "/OrbitControls.js"});
    } catch (const view::ViewError& error) {
      fail(StatusCode::FileNotFound, error.what());
    }
  }

  std::size_t frameCount() const { return frameCount_; }

 private:
  /// Pages have y upwards: the world is turned so that it falls that way.
  void setUp() {
    const Eigen::Vector3d down = toEigen(world_->bullet().getGravity());
    if (down.norm() > 0.0) up_ = Eigen::Quaterniond::FromTwoVectors(-down, Eigen::Vector3d::UnitY());
  }
  Eigen::Affine3d placeOf(const RigidHandle& rigid) const {
    const btTransform& pose = alive(rigid).getWorldTransform();
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) place.linear()(i, j) = static_cast<double>(pose.getBasis()[i][j]);
    }
    place.translation() = toEigen(pose.getOrigin());
    if (!place.matrix().allFinite()) fail(StatusCode::NonFinite, "a rigid body's place is not finite");
    return up_ * place;
  }
  std::vector<Eigen::Vector3d> nodesOf(const BodyHandle& body) const {
    const btSoftBody& soft = alive(body).body();
    std::vector<Eigen::Vector3d> nodes;
    for (int k = 0; k < soft.m_nodes.size(); ++k) nodes.push_back(up_ * toEigen(soft.m_nodes[k].m_x));
    if (firstUnusable(viewOf(std::as_const(nodes))) != nodes.size())
      fail(StatusCode::NonFinite, "a body's nodes are not finite: it has exploded");
    return nodes;
  }

  /// Decides what is shown; on an error, nothing.
  void begin() {
    setUp();
    if (whole_) bodies_.clear();
    moving_.clear();
    movingBoxes_.clear();
    planes_.clear();
    fixed_ = {};
    fixedBox_ = {};
    if (whole_) {
      for (const auto& state : world_->bodies()) bodies_.push_back({world_, state});
    }
    for (const BodyHandle& body : bodies_) (void)nodesOf(body);
    std::vector<TriangleMesh> props;
    for (const auto& state : world_->rigidBodies()) {
      const RigidHandle rigid{world_, state};
      const Eigen::Affine3d place = placeOf(rigid);
      const btCollisionShape& shape = *state->shape;
      const bool fixed = state->body->isStaticObject() && !state->body->isKinematicObject();
      if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
        const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
        const Eigen::Vector3d normal = toEigen(plane.getPlaneNormal());
        planes_.emplace_back(place.linear() * normal, place * (static_cast<double>(plane.getPlaneConstant()) * normal));
      } else if (fixed) {
        append(oneGroup(moved(meshOf(shape), place), "fixed"), fixed_);
      } else if (whole_) {
        moving_.push_back(rigid);
        props.push_back(oneGroup(meshOf(shape), "moving"));
        movingBoxes_.push_back(boundingBox(props.back().positions));
      }
    }
    if (bodies_.empty() && moving_.empty() && planes_.empty() && fixed_.positions.empty())
      fail(StatusCode::Empty, "there is nothing to show: the world has no bodies");
    fixedBox_ = boundingBox(fixed_.positions);
    makePage(props);
  }

  void makePage(const std::vector<TriangleMesh>& props) {
    const bool mixed = std::any_of(bodies_.begin(), bodies_.end(), [&](const BodyHandle& body) {
      return interpolationOf(body) != interpolationOf(bodies_.front());
    });
    page_.emplace(title_, facts(), bodies_.empty() ? Interpolation::Linear : interpolationOf(bodies_.front()),
                  kMaterials);
    page_->setRate(rate_);
    std::map<const void*, std::size_t> models;  // bodies of one binding share everything drawn except the colour
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const World::Body& state = *bodies_[i].state;
      const auto [model, isNew] = models.try_emplace(state.binding ? static_cast<const void*>(state.binding.get())
                                                                   : static_cast<const void*>(state.cage.get()));
      if (isNew) model->second = addModel(state);
      const bool linear = interpolationOf(bodies_[i]) == Interpolation::Linear;
      const bool coloured = state.binding && state.mesh->groups.size() > 1;
      page_->addBody({model->second, "",
                      !mixed   ? ""
                      : linear ? "linear"
                               : "quadratic",
                      coloured ? "" : "soft " + std::to_string(i % kSoftColours)});
    }
    for (const TriangleMesh& prop : props) page_->addProp(prop);
  }
  static Interpolation interpolationOf(const BodyHandle& body) {
    return body.state->binding ? body.state->binding->options().interpolation : Interpolation::Linear;
  }
  /// Shows a body without a surface by its cage's boundary.
  std::size_t addModel(const World::Body& state) {
    const Cage& cage = *state.cage;
    if (!state.binding) {
      TriangleMesh boundary;
      boundary.positions = cage.mesh.nodes;
      boundary.triangles = boundaryFaces(cage.mesh);
      return page_->addSurface(boundary);
    }
    try {
      return page_->addModel(cage, *state.mesh, state.binding->embedding());
    } catch (const view::ViewError& error) {
      fail(StatusCode::CageMismatch, error.what());
    }
  }
  std::vector<std::string> facts() const {
    std::size_t vertices = 0, tets = 0;
    for (const BodyHandle& body : bodies_) {
      if (body.state->mesh) vertices += body.state->mesh->vertexCount();
      tets += body.state->cage->mesh.tetCount();
    }
    std::vector<std::string> facts;
    if (bodies_.size() > 1) facts.push_back(fact(bodies_.size(), "soft body", "soft bodies"));
    if (vertices > 0) facts.push_back(fact(vertices, "vertex", "vertices"));
    if (tets > 0) facts.push_back(fact(tets, "tet", "tets"));
    return facts;
  }

  /// A square of the plane, below the middle of the scene: a floor if it is level.
  static TriangleMesh planeMesh(const Eigen::Hyperplane<double, 3>& plane, const Eigen::Vector3d& middle, double size) {
    const Eigen::Vector3d normal = plane.normal(), centre = plane.projection(middle);
    const bool level = normal.y() > kLevel;
    const Eigen::Vector3d along = size * (level ? kGroundReach : kWallReach) * normal.unitOrthogonal(),
                          across = normal.cross(along);
    TriangleMesh square;
    square.positions = {centre - along - across, centre + along - across, centre + along + across,
                        centre - along + across};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    return oneGroup(std::move(square), level ? "floor" : "wall");
  }

  std::shared_ptr<World> world_;
  std::string title_;
  double rate_;
  bool whole_ = true;
  std::size_t frameCount_ = 0;
  std::vector<BodyHandle> bodies_;
  std::vector<RigidHandle> moving_;
  std::vector<Box3> movingBoxes_;
  std::vector<Eigen::Hyperplane<double, 3>> planes_;
  TriangleMesh fixed_;
  Box3 box_, fixedBox_;
  Eigen::Quaterniond up_ = Eigen::Quaterniond::Identity();
  std::optional<ViewPage> page_;
};

/// The module tetskin/page.py.
nb::object page() {
  return nb::module_::import_("tetskin.page");
}

constexpr const char* kShowWords =
    "Draws the current state in a notebook: drag to turn, use the wheel to zoom. height: pixels. Needs IPython; the "
    "notebook keeps the page, about 1 MB and more. Elsewhere: save_page.";
constexpr const char* kSaveWords =
    "Writes the page of `show` as one HTML file, which any browser opens without a network.";

}  // namespace

void bindPages(nb::module_& module, Class<World>& world, Class<BodyHandle>& body) {
  Class<PageWriter>(module, "PageWriter", "The writer of a Film.")
      .def(
          "__init__",
          [](PageWriter* self, const std::shared_ptr<World>& w, const std::optional<BodyHandle>& only, double rate,
             const std::string& title) {
            if (only) (void)alive(*only);
            new (self) PageWriter(w, only, rate, title);
          },
          "world"_a, "body"_a = nb::none(), nb::kw_only(), "frames_per_second"_a = 60.0, "title"_a = "",
          "body: shown alone, with the fixed objects.")
      .def("add_frame", &PageWriter::addFrame, "Adds the current state.")
      .def("html", &PageWriter::html, "folder"_a, "The page. folder: contains the files that it is made from.")
      .def_prop_ro("frame_count", &PageWriter::frameCount, "Number of frames added.");
  world
      .def(
          "show",
          [](const std::shared_ptr<World>& w, int height) { page().attr("show_world")(w, "height"_a = height); },
          nb::kw_only(), "height"_a = 480, kShowWords)
      .def(
          "save_page",
          [](const std::shared_ptr<World>& w, const PathLike& path) { page().attr("save_world")(w, path.object); },
          "path"_a, kSaveWords);
  body.def(
          "show", [](const BodyHandle& b, int height) { page().attr("show_world")(b.world, b, "height"_a = height); },
          nb::kw_only(), "height"_a = 480, kShowWords)
      .def(
          "save_page",
          [](const BodyHandle& b, const PathLike& path) { page().attr("save_world")(b.world, path.object, b); },
          "path"_a, kSaveWords);
}

}  // namespace tetskin::python
