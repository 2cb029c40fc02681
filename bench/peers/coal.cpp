// Another side of the race: coal 3.0 (once HPP-FCL) on the scenes that bench/race.rs writes.
//
//   coal edges SCENE PAIRS VERDICTS   as `race edges` of race.cpp
//
// Build, with the headers and libraries that the Python package brings:
//   python3 -m venv VENV && VENV/bin/pip install coal
//   PREFIX=$(echo VENV/lib/python3*/site-packages/cmeel.prefix)
//   g++ -O3 -march=x86-64 -std=c++17 coal.cpp -o COAL -I$PREFIX/include -I/usr/include/eigen3 \
//       -L$PREFIX/lib -Wl,-rpath,$PREFIX/lib -lcoal
#include "scene.h"

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>

#include <cmath>
#include <memory>

using Model = coal::BVHModel<coal::OBBRSS>;
using Rotation = Eigen::Quaterniond;

struct Corners {
  size_t corners[3];
  Corners(size_t a, size_t b, size_t c) : corners{a, b, c} {}
};

static std::shared_ptr<Model> read_model(std::istream& in) {
  std::vector<coal::Vec3s> points;
  std::vector<Corners> faces;
  read_mesh(in, points, faces);
  auto model = std::make_shared<Model>();
  model->beginModel(faces.size(), points.size());
  for (const auto& [corners] : faces) model->addTriangle(points[corners[0]], points[corners[1]], points[corners[2]]);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

struct Pose {
  coal::Vec3s position;
  Rotation rotation;
  explicit Pose(const double* q) : position(q[0], q[1], q[2]), rotation(q[3], q[4], q[5], q[6]) {}
};

struct Pair {
  Pose a, b;
  int steps;
};

int main(int count, char** words) {
  if (count != 5 || std::string(words[1]) != "edges") fail("edges SCENE PAIRS VERDICTS expected");
  std::ifstream in(words[2]);
  read_head(in);
  const auto world = read_model(in), robot = read_model(in);
  std::vector<Pair> pairs;
  read_pairs(words[3], [&](const double* a, const double* b, int steps) { pairs.push_back({Pose(a), Pose(b), steps}); });
  const coal::ComputeCollision collide(robot.get(), world.get());
  const coal::CollisionRequest request(coal::NO_REQUEST, 1);
  const coal::Transform3s still;
  Interior interior;
  return decide(pairs, words[4], [&](const Pair& pair) {
    return interior.free(pair.steps, [&](int step) {
      const double t = double(step) / pair.steps;
      const coal::Transform3s pose(pair.a.rotation.slerp(t, pair.b.rotation).toRotationMatrix(),
                                   pair.a.position + t * (pair.b.position - pair.a.position));
      coal::CollisionResult result;
      return collide(pose, still, request, result) == 0;
    });
  });
}
