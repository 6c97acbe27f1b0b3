// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/shape_build.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tetskin::contact_detail {

using bullet_detail::areBelow;
using bullet_detail::BuildStream;

namespace {

void visitPart(BuildStream& stream, TetSubregion& part) {
  stream.plain(part.minimum, 4);
  stream(part.left);
}

void visitTree(BuildStream& stream, SearchTree& tree) {
  tree.tree.visitState(stream);
  if (stream.restoring() && !stream.failed() && tree.tree.isValid()) tree = SearchTree(std::move(tree.tree));
}

void visitShape(BuildStream& stream, ShapeData& data) {
  const auto vector = [&](btVector3& v) { stream(v); };
  stream.each(data.nodes, vector);
  stream.each(data.tets, [&](Tet& tet) { stream.plain(tet.data(), tet.size()); });
  stream(data.edge);
  data.grid.visitState(stream);
  stream.each(data.runs, [&](SampleRun& run) { stream(run.tet), stream(run.first), stream(run.last); });
  stream.each(data.samples, [&](EmbeddedPoint<btScalar>& sample) { visitEmbedded(stream, sample); });
  stream.each(data.sampleRest, vector);
  stream.each(data.sampleNormals, vector);
  stream.array(data.sampleNodes);
  for (std::vector<btScalar>& weights : data.weights) stream.array(weights);
  stream.each(data.carried, [&](CarriedCells& cells) { stream(cells.bits); });
  stream.each(data.filled, [&](TetSubregion& part) { visitPart(stream, part); });
  visitTree(stream, data.runTree);
  visitTree(stream, data.tetTree);
}

/// One after the other, in the order of the tets.
bool areRuns(const std::vector<SampleRun>& runs, std::size_t tets, std::size_t samples) {
  int next = 0, lastTet = -1;
  for (const SampleRun& run : runs) {
    if (run.first != next || run.last <= run.first || run.tet <= lastTet) return false;
    next = run.last;
    lastTet = run.tet;
  }
  return static_cast<std::size_t>(next) == samples && lastTet < static_cast<int>(tets);
}

bool isTreeOf(const SearchTree& tree, std::size_t count, int leafSize) {
  const auto fits = [leafSize](const Bvh::Node& node) { return !node.isLeaf() || node.last - node.first <= leafSize; };
  const std::vector<Bvh::Node>& nodes = tree.tree.nodes();
  return tree.past.size() == nodes.size() && tree.tree.isValid() && areBelow(tree.tree.items(), count) &&
         std::all_of(nodes.begin(), nodes.end(), fits);
}

bool isValid(const ShapeData& data) {
  const std::size_t nodes = data.nodes.size(), tets = data.tets.size(), samples = data.samples.size();
  const auto inTets = [&](const Tet& tet) { return areBelow(tet, nodes); };
  const auto isSample = [&](const EmbeddedPoint<btScalar>& s) {
    return s.tet >= 0 && static_cast<std::size_t>(s.tet) < tets && areBelow(s.nodes, nodes);
  };
  const auto areWeights = [&](const std::vector<btScalar>& w) {
    return w.size() == samples + kLanes - 1 &&
           std::all_of(w.begin(), w.end(), [](btScalar x) { return std::isfinite(x); });
  };
  return std::all_of(data.tets.begin(), data.tets.end(), inTets) && data.edge > 0 && std::isfinite(data.edge) &&
         data.grid.isValid() && areRuns(data.runs, tets, samples) &&
         std::all_of(data.samples.begin(), data.samples.end(), isSample) && data.sampleRest.size() == samples &&
         data.sampleNormals.size() == samples && data.sampleNodes.size() == samples &&
         areBelow(data.sampleNodes, nodes) && std::all_of(data.weights, data.weights + 4, areWeights) &&
         (data.carried.empty() || data.carried.size() == tets) && data.filled.size() == tets &&
         isTreeOf(data.runTree, data.runs.size(), samples > 0 ? static_cast<int>(samples) : 1) &&
         isTreeOf(data.tetTree, tets, kLanes);
}

/// Only called for one that was not described, or built, yet.
std::shared_ptr<const ContactShape> buildNew(BuildStream& stream, const ContactShape* shape) {
  auto data = shape ? std::make_unique<ShapeData>(dataOf(*shape)) : std::make_unique<ShapeData>();
  stream.copied([&](BuildStream& bytes) { visitShape(bytes, *data); });
  if (shape || stream.failed()) return nullptr;
  stream.require(isValid(*data), "a contact shape is damaged");
  if (stream.failed()) return nullptr;
  completeShape(*data);
  return Access<ContactShape>::create(std::move(data));
}

}  // namespace

std::shared_ptr<const ContactShape> buildContactShape(BuildStream& stream, const ContactShape* shape) {
  return stream.shared(bullet_detail::SharedKind::ContactShape, shape, [&] { return buildNew(stream, shape); });
}

}  // namespace tetskin::contact_detail
