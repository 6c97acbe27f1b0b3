// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <support/bars.h>
#include <tetskin/core/cage.h>
#include <tetskin/elastic/vibration_modes.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

const TetMesh& box() {
  static const TetMesh mesh = makeBox({3, 2, 2}, Vector3d(3, 2, 2));
  return mesh;
}

VibrationOptions few(int modes = 4) {
  VibrationOptions options;
  options.modeCount = modes;
  return options;
}

void expectError(const Cage& tets, const VibrationOptions& options, StatusCode code, const char* says) {
  const Result<VibrationModes> modes = computeVibrationModes(tets, options);
  ASSERT_FALSE(modes.ok()) << says;
  EXPECT_EQ(modes.status().code, code) << modes.status().message;
  EXPECT_NE(modes.status().message.find(says), std::string::npos) << modes.status().message;
}

TEST(BadVibrations, FewerNodesThanModes) {
  expectError(box(), few(37), StatusCode::InvalidOption, "more than the 36 free nodes");
  EXPECT_TRUE(computeVibrationModes(box(), few(36)).ok());
  expectError(box(), few(0), StatusCode::InvalidOption, "number of modes");
}

TEST(BadVibrations, PartsThatNothingHoldsTogether) {
  TetMesh two = box();
  const int shift = static_cast<int>(two.nodeCount());
  for (const Vector3d& node : box().nodes) two.nodes.push_back(node + Vector3d(10, 0, 0));
  for (Tet tet : box().tets) {
    for (int& node : tet) node += shift;
    two.tets.push_back(tet);
  }
  expectError(two, few(), StatusCode::Degenerate, "2 components");
}

TEST(BadVibrations, PartsThatHangTogetherByAnEdge) {
  TetMesh hinged;
  hinged.nodes = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.5, 1, 0}, {-1, 0, 0}, {-0.5, -1, 0}};
  hinged.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  (void)repairTetMesh(hinged);
  expectError(hinged, few(), StatusCode::Degenerate, "without resistance");
}

TEST(BadVibrations, FlatTetsAndLooseNodes) {
  TetMesh flat = box();
  flat.tets.push_back({0, 1, 2, 3});
  expectError(flat, few(), StatusCode::Degenerate, "flat");
  TetMesh loose = box();
  loose.nodes.emplace_back(9, 9, 9);
  expectError(loose, few(), StatusCode::Degenerate, "in no tet");
  expectError({}, few(), StatusCode::Empty, "");
}

TEST(BadVibrations, PinnedNodes) {
  VibrationOptions options = few(2);
  for (int n = 0; n < static_cast<int>(box().nodeCount()); ++n) options.pinned.push_back(n);
  expectError(box(), options, StatusCode::InvalidOption, "all nodes are pinned");
  options.pinned = {0, 36};
  expectError(box(), options, StatusCode::IndexOutOfRange, "36");
  options.pinned = {0, 1};  // the body can turn about them
  expectError(box(), options, StatusCode::Degenerate, "too few nodes are pinned");
}

TEST(BadVibrations, MaterialAndArrays) {
  VibrationOptions options = few();
  for (const double ratio : {-0.1, 0.5, std::nan("")}) {
    options.poissonRatio = ratio;
    expectError(box(), options, StatusCode::InvalidOption, "Poisson");
  }
  options = few();
  options.stiffnessScale = {1.0};
  expectError(box(), options, StatusCode::SizeMismatch, "stiffnessScale");
  options = few();
  options.nodeMasses.assign(box().nodeCount(), 0.0);
  expectError(box(), options, StatusCode::InvalidOption, "nodeMasses");
}

TEST(BadVibrations, CagesThatAreNotWhatTheySay) {
  Cage cage = refineQuadratic(box()).value();
  cage.quadraticTet[3] = -1;
  expectError(cage, few(), StatusCode::InvalidOption, "quadraticTet");
  cage = box();
  cage.masses = {1.0};
  expectError(cage, few(), StatusCode::SizeMismatch, "masses");
}

class SavedModes : public testing::Test {
 protected:
  SavedModes() {
    VibrationOptions options = few();
    options.pinned = {0, 1, 4, 12};
    modes_ = computeVibrationModes(box(), options).value();
    bytes_ = modes_.save(box());
  }
  Status load(const std::vector<unsigned char>& bytes, const TetMesh& tets = box()) {
    return VibrationModes::load(bytes.data(), bytes.size(), tets).status();
  }

  VibrationModes modes_;
  std::vector<unsigned char> bytes_;
};

TEST_F(SavedModes, ComeBackToTheBit) {
  const Result<VibrationModes> again = VibrationModes::load(bytes_.data(), bytes_.size(), box());
  ASSERT_TRUE(again.ok()) << again.status().message;
  EXPECT_EQ(again.value().eigenvalues, modes_.eigenvalues);
  EXPECT_EQ(again.value().shapes, modes_.shapes);
  EXPECT_EQ(again.value().masses, modes_.masses);
  EXPECT_EQ(again.value().pinned, modes_.pinned);
  EXPECT_EQ(again.value().nodes, box().nodes);
  EXPECT_EQ(again.value().poissonRatio, modes_.poissonRatio);
}

TEST_F(SavedModes, AreOfTheirTetsAlone) {
  TetMesh moved = box();
  moved.nodes[5].x() += 1e-15;
  EXPECT_EQ(load(bytes_, moved).code, moved.nodes[5] == box().nodes[5] ? StatusCode::Ok : StatusCode::CageMismatch);
  moved.nodes[5].x() += 1e-9;
  EXPECT_EQ(load(bytes_, moved).code, StatusCode::CageMismatch);
  TetMesh turned = box();
  std::swap(turned.tets[0], turned.tets[1]);
  EXPECT_EQ(load(bytes_, turned).code, StatusCode::CageMismatch);
}

TEST_F(SavedModes, AreNotOfTheSameTetsIfTheseAreQuadratic) {
  Cage quadratic = refineQuadratic(box()).value(), linear = quadratic, neither = quadratic;
  linear.quadraticTet.assign(linear.mesh.tetCount(), -1);
  neither.quadraticTet.clear();
  const std::vector<unsigned char> ofLinear = computeVibrationModes(linear, few()).value().save(linear);
  const std::vector<unsigned char> ofQuadratic = computeVibrationModes(quadratic, few()).value().save(quadratic);
  const auto code = [](const std::vector<unsigned char>& bytes, const Cage& cage) {
    return VibrationModes::load(bytes.data(), bytes.size(), cage).status().code;
  };
  EXPECT_EQ(code(ofLinear, neither), StatusCode::Ok);
  EXPECT_EQ(code(ofQuadratic, quadratic), StatusCode::Ok);
  EXPECT_EQ(code(ofLinear, quadratic), StatusCode::CageMismatch);
  EXPECT_EQ(code(ofQuadratic, linear), StatusCode::CageMismatch);
}

TEST_F(SavedModes, AreRefusedWithAnyByteChanged) {
  for (std::size_t k = 0; k < bytes_.size(); ++k) {
    std::vector<unsigned char> damaged = bytes_;
    damaged[k] ^= 0x10;
    const Status status = load(damaged);
    ASSERT_FALSE(status.ok()) << "byte " << k;
    ASSERT_FALSE(status.message.empty());
  }
}

TEST_F(SavedModes, AreRefusedWhereTheyEndTooSoonOrLate) {
  for (std::size_t size = 0; size < bytes_.size(); ++size) {
    ASSERT_FALSE(load({bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size)}).ok()) << size;
  }
  std::vector<unsigned char> longer = bytes_;
  longer.push_back(0);
  EXPECT_EQ(load(longer).code, StatusCode::Malformed);
}

TEST_F(SavedModes, SayWhichVersionTheyAreOf) {
  bytes_[8] = 2;
  EXPECT_EQ(load(bytes_).code, StatusCode::UnsupportedFormat);
  EXPECT_NE(load(bytes_).message.find("version 2"), std::string::npos);
  bytes_[0] = 'x';
  EXPECT_EQ(load(bytes_).code, StatusCode::UnsupportedFormat);
}

}  // namespace
}  // namespace tetskin::test
