// The other side of the study cost-ompl of bench/uniform: OMPL's samplers of valid states over FCL's collision checks.
//
//   samplers draw SCENE KIND DISTANCE COUNT SEED
//       COUNT samples by a sampler (uniform, gaussian, obstacle or bridge) with this standard deviation, which the first and the third
//       do not have; prints the CPU seconds that they took, and how many states were checked
//   samplers check SCENE CONFIGS
//       prints for each configuration x y z qw qx qy qz of a file whether it is valid (1 or 0)
//
// A scene is the bounds' least and largest x y z, the edge of the cube that moves, and an obstacle a line: `sphere x y z radius` or
// `box x y z a b c`. Spheres and boxes are FCL's own shapes, so that they are solid, as ours are.
//
// Build: g++ -O3 -march=x86-64 -std=c++17 samplers.cpp -I/usr/include/eigen3 -I/usr/include/ompl-1.5 -lompl -lfcl -lccd
#include "scene.h"

#include <fcl/fcl.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/samplers/BridgeTestValidStateSampler.h>
#include <ompl/base/samplers/GaussianValidStateSampler.h>
#include <ompl/base/samplers/ObstacleBasedValidStateSampler.h>
#include <ompl/base/samplers/UniformValidStateSampler.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cstdio>
#include <memory>

namespace ob = ompl::base;
using SE3 = ob::SE3StateSpace;
using Object = fcl::CollisionObjectd;

struct Scene {
  double low[3], high[3], edge;
  std::vector<std::shared_ptr<Object>> obstacles;
  fcl::DynamicAABBTreeCollisionManagerd manager;
};

static void read_scene(const char* path, Scene& scene) {
  std::ifstream in(path);
  for (double& value : scene.low) in >> value;
  for (double& value : scene.high) in >> value;
  if (!(in >> scene.edge)) fail("a scene expected");
  std::string kind;
  double x, y, z;
  while (in >> kind >> x >> y >> z) {
    std::shared_ptr<fcl::CollisionGeometryd> shape;
    if (kind == "sphere") {
      double radius;
      in >> radius;
      shape = std::make_shared<fcl::Sphered>(radius);
    } else if (kind == "box") {
      double a, b, c;
      in >> a >> b >> c;
      shape = std::make_shared<fcl::Boxd>(a, b, c);
    } else {
      fail("sphere or box expected");
    }
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = fcl::Vector3d(x, y, z);
    scene.obstacles.push_back(std::make_shared<Object>(shape, pose));
    scene.manager.registerObject(scene.obstacles.back().get());
  }
  scene.manager.setup();
}

/// Called for pairs whose boxes meet; the search ends with the first that collides.
static bool touches(Object* a, Object* b, void* found) {
  static const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  if (fcl::collide(a, b, request, result) != 0) *static_cast<bool*>(found) = true;
  return *static_cast<bool*>(found);
}

struct Checker : ob::StateValidityChecker {
  const Scene& scene;
  mutable Object robot;
  mutable size_t asked = 0;

  Checker(const ob::SpaceInformationPtr& si, const Scene& scene)
      : ob::StateValidityChecker(si), scene(scene), robot(std::make_shared<fcl::Boxd>(scene.edge, scene.edge, scene.edge)) {}

  bool isValid(const ob::State* any) const override {
    ++asked;
    if (!si_->satisfiesBounds(any)) return false;
    const auto* state = any->as<SE3::StateType>();
    const auto& q = state->rotation();
    robot.setRotation(fcl::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix());
    robot.setTranslation(fcl::Vector3d(state->getX(), state->getY(), state->getZ()));
    robot.computeAABB();
    bool found = false;
    scene.manager.collide(&robot, &found, touches);
    return !found;
  }
};

int main(int count, char** words) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  if (count < 4) fail("draw or check expected, with what the first lines of samplers.cpp say");
  // Before anything is drawn, which a space does as it is set up.
  if (count == 7) ompl::RNG::setSeed(std::strtoul(words[6], nullptr, 10));
  Scene scene;
  read_scene(words[2], scene);
  auto space = std::make_shared<SE3>();
  ob::RealVectorBounds bounds(3);
  for (int i = 0; i < 3; ++i) {
    bounds.setLow(i, scene.low[i]);
    bounds.setHigh(i, scene.high[i]);
  }
  space->setBounds(bounds);
  auto si = std::make_shared<ob::SpaceInformation>(space);
  auto checker = std::make_shared<Checker>(si, scene);
  si->setStateValidityChecker(checker);
  si->setup();
  auto* state = si->allocState()->as<SE3::StateType>();
  const std::string mode = words[1];
  if (mode == "check") {
    std::ifstream in(words[3]);
    double q[7];
    for (;;) {
      for (double& value : q) in >> value;
      if (!in) return 0;
      state->setXYZ(q[0], q[1], q[2]);
      auto& rotation = state->rotation();
      rotation.w = q[3];
      rotation.x = q[4];
      rotation.y = q[5];
      rotation.z = q[6];
      std::printf("%d\n", checker->isValid(state));
    }
  }
  if (mode != "draw" || count != 7) fail("draw SCENE KIND DISTANCE COUNT SEED expected");
  const std::string kind = words[3];
  const double distance = std::strtod(words[4], nullptr);
  std::shared_ptr<ob::ValidStateSampler> sampler;
  if (kind == "uniform") sampler = std::make_shared<ob::UniformValidStateSampler>(si.get());
  if (kind == "obstacle") sampler = std::make_shared<ob::ObstacleBasedValidStateSampler>(si.get());
  if (kind == "gaussian") {
    auto gaussian = std::make_shared<ob::GaussianValidStateSampler>(si.get());
    gaussian->setStdDev(distance);
    sampler = gaussian;
  }
  if (kind == "bridge") {
    auto bridge = std::make_shared<ob::BridgeTestValidStateSampler>(si.get());
    bridge->setStdDev(distance);
    sampler = bridge;
  }
  if (!sampler) fail("uniform, gaussian, obstacle or bridge expected");
  const int samples = std::atoi(words[5]);
  const double begun = cpu_seconds();
  for (int found = 0; found < samples;) found += sampler->sample(state);
  std::printf("%.6f %zu\n", cpu_seconds() - begun, checker->asked);
  return 0;
}
