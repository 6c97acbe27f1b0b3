// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::python {
namespace {

/// With the world's lock. If a forked process cannot get it, the memory leaks.
template <class T>
void letGo(World& world, std::unique_ptr<T>& thing) noexcept {
  if (!thing) return;
  try {
    const Locked lock(world);
    thing.reset();
  } catch (const Failure&) {
    (void)thing.release();
  }
}

/// A recording; null once it is closed. The world outlives it.
struct RecorderHandle {
  ~RecorderHandle() { letGo(*world, recorder); }
  void close() {
    if (!recorder) return;
    const Locked lock(*world);
    recorder.reset();
  }
  Recorder& open() const {
    if (!recorder) fail(StatusCode::Released, "the recorder has been closed");
    return *recorder;
  }

  std::shared_ptr<World> world;
  std::unique_ptr<Recorder> recorder;
};

struct ReplayHandle {
  ReplayHandle(std::shared_ptr<World> ofWorld, std::unique_ptr<Replay> ofFile)
      : world(std::move(ofWorld)), replay(std::move(ofFile)) {
    replay->onChange([this](std::size_t step) {
      const nb::gil_scoped_acquire acquire;
      const nb::object call = change;  // which may set another one
      if (!call.is_valid()) return;
      try {
        call(step);
      } catch (...) {
        raised = std::current_exception();
      }
    });
  }
  ~ReplayHandle() { letGo(*world, replay); }

  std::shared_ptr<World> world;
  std::unique_ptr<Replay> replay;
  nb::object change;
  std::exception_ptr raised;
};

/// Objects that `change` refers to may refer to the replay: Python's collector finds and breaks such cycles.
int traverse(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
  Py_VISIT(Py_TYPE(self));
#endif
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<ReplayHandle>(self)->change.ptr());
  return 0;
}
int clear(PyObject* self) {
  const nb::object change = std::move(nb::inst_ptr<ReplayHandle>(self)->change);
  return 0;
}
PyType_Slot replaySlots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

int recordedStep(RecorderHandle& r, double dt, int substeps) {
  (void)r.open();
  const int made = unlocked(*r.world, [&] {
    return facade::step(*r.world, dt, substeps, [&](btScalar whole, int count, btScalar substep) {
      return r.recorder->step(whole, count, substep);
    });
  });
  check(r.recorder->status());
  return made;
}

bool replayedStep(ReplayHandle& r) {
  const bool made = unlocked(*r.world, [&] { return take(r.world->step(*r.replay)); });
  if (r.raised) std::rethrow_exception(std::exchange(r.raised, nullptr));
  check(r.replay->status());
  return made;
}

}  // namespace

void bindRuns(nb::module_& module, Class<World>&) {
  Class<RecorderHandle>(module, "Recorder",
                        "Writes a run to a file, from which Replay plays it again to the last bit. Call its step "
                        "instead of the world's; a context manager.")
      .words([](const RecorderHandle& r) {
        return r.recorder ? counted(r.recorder->steps(), "step", "steps") : std::string("closed");
      })
      .def(
          "__init__",
          [](RecorderHandle* self, const std::shared_ptr<World>& world, const PathLike& path,
             const std::string& description, int snapshotEvery) {
            RecorderOptions options;
            options.description = description;
            options.snapshotEvery = snapshotEvery;
            const Locked lock(*world);
            auto recorder = take(Recorder::start(world->bullet(), path.text(), options));
            new (self) RecorderHandle{world, std::move(recorder)};
          },
          "world"_a, "path"_a, nb::kw_only(), "description"_a = "", "snapshot_every"_a = 240,
          "description: how to build the world, for whoever plays the file. snapshot_every: steps between two "
          "snapshots in the file.")
      .def("step", recordedStep, "dt"_a = 1.0 / 60.0, nb::kw_only(), "substeps"_a = 4,
           "Like World.step, and records it.")
      .def_prop_ro(
          "steps", [](const RecorderHandle& r) { return r.open().steps(); }, "Number of steps recorded.")
      .def("close", &RecorderHandle::close)
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> Recorder"))
      .def(
          "__exit__", [](RecorderHandle& r, const nb::args&) { r.close(); },
          nb::sig("def __exit__(self, *args: object) -> None"));

  Class<ReplayHandle>(
      module, "Replay", nb::type_slots(replaySlots),
      "Plays a run from a file, in a world with the same bodies as the recorded one, made in the same order.")
      .words([](const ReplayHandle& r) { return counted(r.replay->report().steps, "step", "steps") + " played"; })
      .def(
          "__init__",
          [](ReplayHandle* self, const std::shared_ptr<World>& world, const PathLike& path) {
            const Locked lock(*world);
            new (self) ReplayHandle(world, take(world->replay(path.text())));
          },
          "world"_a, "path"_a, "Puts the world into the state at the start of the recording.")
      .def("step", replayedStep,
           "Makes the next step of the file. Returns False, without a step, at the end of the file or after a step "
           "whose state differs from the recorded one.")
      .def(
          "on_change",
          [](ReplayHandle& r, const nb::typed<nb::callable, nb::object(std::size_t)>& change) { r.change = change; },
          "change"_a,
          "Called with the number of the step before which bodies, objects or joints were added or removed: does it "
          "again.")
      .def_prop_ro(
          "steps", [](const ReplayHandle& r) { return r.replay->report().steps; }, "Steps played.")
      .def_prop_ro(
          "differs", [](const ReplayHandle& r) { return r.replay->report().differs; },
          "Whether the last step has ended in another state than the recorded one.")
      .def_prop_ro(
          "differing_object", [](const ReplayHandle& r) { return r.replay->report().object; },
          "If it differs, the first object whose motion differs.")
      .def_prop_ro(
          "cut_short", [](const ReplayHandle& r) { return r.replay->report().cutShort; },
          "Whether the file ends within a step.")
      .def_static(
          "description_of", [](const PathLike& path) { return textOf(take(Replay::descriptionOf(path.text()))); },
          "path"_a, "The description given at the recording of a file.");
}

}  // namespace tetskin::python
