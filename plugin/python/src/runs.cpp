// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <nanobind/stl/filesystem.h>

namespace tetskin::python {
namespace {

/// A recording, or, once it is closed, none. The world outlives it.
struct RecorderHandle {
  ~RecorderHandle() { close(); }
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
  ~ReplayHandle() {
    const Locked lock(*world);
    replay.reset();
  }

  std::shared_ptr<World> world;
  std::unique_ptr<Replay> replay;
  nb::object change;
  std::exception_ptr raised;
};

int recordedStep(RecorderHandle& r, double dt, int substeps) {
  (void)r.open();
  const int made = unlocked(*r.world, [&] {
    return r.world->step(dt, substeps, [&](btScalar whole, int count, btScalar substep) {
      return r.recorder->step(whole, count, substep);
    });
  });
  check(r.recorder->status());
  return made;
}

bool replayedStep(ReplayHandle& r) {
  const bool made = unlocked(*r.world, [&] {
    const bool stepped = r.replay->step();
    if (stepped) r.world->updateSkins();
    return stepped;
  });
  if (r.raised) std::rethrow_exception(std::exchange(r.raised, nullptr));
  check(r.replay->status());
  return made;
}

void onChange(ReplayHandle& r, const nb::typed<nb::callable, nb::object(std::size_t)>& change) {
  const Locked lock(*r.world);
  r.change = change;
  r.replay->onChange([&r](std::size_t step) {
    const nb::gil_scoped_acquire acquire;
    try {
      r.change(step);
    } catch (...) {
      r.raised = std::current_exception();
    }
  });
}

}  // namespace

void bindRuns(nb::module_& module, Class<World>&) {
  Class<RecorderHandle>(module, "Recorder",
                        "Writes a run to a file, from which Replay plays it again to the last bit. Step by it in "
                        "place of the world; a context manager.")
      .def(
          "__init__",
          [](RecorderHandle* self, const std::shared_ptr<World>& world, const std::filesystem::path& path,
             const std::string& description, int snapshotEvery) {
            RecorderOptions options;
            options.description = description;
            options.snapshotEvery = snapshotEvery;
            const Locked lock(*world);
            auto recorder = take(Recorder::start(world->bullet(), path.u8string(), options));
            new (self) RecorderHandle{world, std::move(recorder)};
          },
          "world"_a, "path"_a, nb::kw_only(), "description"_a = "", "snapshot_every"_a = 240,
          "description: for whoever plays the file: how the world is built. snapshot_every: steps from one snapshot in "
          "the file to the next.")
      .def("step", recordedStep, "dt"_a = 1.0 / 60.0, nb::kw_only(), "substeps"_a = 4, "As World.step, and records it.")
      .def_prop_ro(
          "steps", [](const RecorderHandle& r) { return r.open().steps(); }, "Number of steps recorded.")
      .def("close", &RecorderHandle::close)
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> Recorder"))
      .def(
          "__exit__", [](RecorderHandle& r, const nb::args&) { r.close(); },
          nb::sig("def __exit__(self, *args: object) -> None"));

  Class<ReplayHandle>(
      module, "Replay",
      "Plays a run from a file, in a world with the same bodies as the recorded one, made in the same order.")
      .def(
          "__init__",
          [](ReplayHandle* self, const std::shared_ptr<World>& world, const std::filesystem::path& path) {
            const Locked lock(*world);
            auto replay = take(Replay::open(world->bullet(), path.u8string()));
            new (self) ReplayHandle{world, std::move(replay), nb::none(), nullptr};
            world->updateSkins();
          },
          "world"_a, "path"_a, "Puts the world into the state in which recording began.")
      .def("step", replayedStep,
           "Makes the next step of the file. False, and none is made, at its end, or after a step that has ended in "
           "another state than the recorded one.")
      .def("on_change", onChange, "change"_a,
           "Called with the number of the step before which bodies, objects or joints were added or removed: does it "
           "again.")
      .def_prop_ro(
          "steps", [](const ReplayHandle& r) { return r.replay->report().steps; }, "Steps played.")
      .def_prop_ro(
          "differs", [](const ReplayHandle& r) { return r.replay->report().differs; },
          "The last step has ended in another state than the recorded one.")
      .def_prop_ro(
          "differing_object", [](const ReplayHandle& r) { return r.replay->report().object; },
          "If so, the first object whose motion differs.")
      .def_prop_ro(
          "cut_short", [](const ReplayHandle& r) { return r.replay->report().cutShort; },
          "The file ends within a step.")
      .def_static(
          "description_of",
          [](const std::filesystem::path& path) { return take(Replay::descriptionOf(path.u8string())); }, "path"_a,
          "The description that a file was recorded with.");
}

}  // namespace tetskin::python
