// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <tetskin/io/animation.h>

namespace tetskin::python {
namespace {

/// A GLB with the soft and rigid bodies of worlds; each frame reads their current state.
class GlbAnimation {
 public:
  GlbAnimation(const PathLike& path, double framesPerSecond)
      : writer_(take(GlbWriter::create(path.text(), framesPerSecond))) {}

  void addBody(const BodyHandle& body, const std::string& name) {
    const Locked lock(*body.world);
    (void)alive(body);
    checkSurface(body);
    checkOpen();
    const World::Body& state = *body.state;
    const std::size_t model = take(writer_.addModel(name, *state.cage, *state.mesh, state.binding->embedding(),
                                                    state.binding->options().interpolation));
    writer_.addBody(model, name);
    bodies_.push_back(body);
  }
  void addObject(const MeshLike& mesh, const std::optional<RigidHandle>& rigid, const std::string& name) {
    const MeshModel model = meshOf(mesh);
    checkOpen();
    check(writer_.addObject(name, *model.mesh, rigid.has_value()));
    if (rigid) rigids_.push_back(*rigid);
  }
  void addFrame() {
    if (finished_) fail(StatusCode::FileNotWritable, "the animation has been finished");
    std::vector<std::vector<Eigen::Vector3d>> nodes(bodies_.size());
    std::vector<PointView<const double>> views;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Locked lock(*bodies_[i].world);
      const btSoftBody& soft = alive(bodies_[i]).body();
      for (int k = 0; k < soft.m_nodes.size(); ++k) nodes[i].push_back(toEigen(soft.m_nodes[k].m_x));
      views.emplace_back(viewOf(std::as_const(nodes[i])));
    }
    std::vector<Eigen::Affine3d> places;
    for (const RigidHandle& rigid : rigids_) {
      const Locked lock(*rigid.world);
      places.push_back(placeOf(alive(rigid).getWorldTransform()));
    }
    check(writer_.addFrame(views, places));
    ++frames_;
  }
  std::size_t frameCount() const { return frames_; }
  void finish() {
    if (finished_) return;
    check(writer_.finish());
    finished_ = true;
  }

 private:
  void checkOpen() const {
    if (frames_ > 0 || finished_) fail(StatusCode::InvalidOption, "add bodies and objects before the first frame");
  }
  static Eigen::Affine3d placeOf(const btTransform& pose) {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) place.linear()(i, j) = static_cast<double>(pose.getBasis()[i][j]);
    }
    place.translation() = toEigen(pose.getOrigin());
    return place;
  }

  GlbWriter writer_;
  std::vector<BodyHandle> bodies_;
  std::vector<RigidHandle> rigids_;
  std::size_t frames_ = 0;
  bool finished_ = false;
};

}  // namespace

void bindAnimations(nb::module_& module) {
  Class<GlbAnimation>(module, "GlbWriter",
                      "Writes a run as one animation, binary glTF 2.0, which engines and viewers play. As a context "
                      "manager it finishes the file.")
      .words([](const GlbAnimation& g) { return counted(g.frameCount(), "frame", "frames"); })
      .def(nb::init<const PathLike&, double>(), "path"_a, "frames_per_second"_a = 60.0)
      .def("add_body", &GlbAnimation::addBody, "body"_a, "name"_a = "body",
           "Shows a soft body by its surface. Call it before the first frame.")
      .def("add_object", &GlbAnimation::addObject, "mesh"_a, "rigid_body"_a = nb::none(), "name"_a = "object",
           "Shows a mesh that is fixed, or moves with a rigid body. Call it before the first frame.")
      .def("add_frame", &GlbAnimation::addFrame, "Adds the current state.")
      .def("finish", &GlbAnimation::finish,
           "Writes the file, complete or not at all. Finishing it again changes nothing.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> GlbWriter"))
      .def(
          "__exit__",
          [](GlbAnimation& g, nb::handle type, nb::handle, nb::handle) {
            if (type.is_none()) g.finish();
          },
          "type"_a.none(), "value"_a.none(), "traceback"_a.none(),
          nb::sig("def __exit__(self, type: type[BaseException] | None, value: BaseException | None, traceback: "
                  "object) -> None"));
}

}  // namespace tetskin::python
