// The other side of what bench/robots.py asks about robots of links: FCL's contacts, and OMPL's RRT-Connect with FCL.
//
//   robots touching SCENE CONFIGS       prints, for every configuration of the file, a line of the pairs of bodies whose
//                                       surfaces meet, as `LINK.BODY:LINK.BODY` or `LINK.BODY:OBSTACLE`
//   robots solve SCENE QUERY SEED LIMIT PATH
//                                       OMPL's RRT-Connect from the first to the second configuration of the file QUERY,
//                                       within LIMIT CPU seconds; writes the path, a configuration a line, and prints the
//                                       CPU seconds, whether it is solved, and whether the path's motions are also free
//                                       at 20 times as many steps
//
// Where links stand is computed here anew, from the joints in the file. `solve` knows robots whose values are all joints
// with limits. A motion is checked in steps that carry no point of the robot farther than the scene's resolution, by the
// joints' levers, and, as MoveIt does, surfaces alone are looked at.
//
// Build: g++ -O3 -march=x86-64 -std=c++17 robots.cpp -o ROBOTS -I/usr/include/eigen3 -I/usr/include/ompl-1.5 -lompl -lfcl -lccd
#include "scene.h"

#include <fcl/fcl.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>

namespace ob = ompl::base;
using Pose = fcl::Transform3d;
using Object = fcl::CollisionObjectd;
/// How many times finer than the planner's the steps are at which a path is looked at again.
constexpr int FINER = 20;

/// Reads `x y z qw qx qy qz`.
static Pose read_pose(std::istream& in) {
  double v[7];
  for (double& value : v) in >> value;
  Pose pose = Pose::Identity();
  pose.linear() = fcl::Quaterniond(v[3], v[4], v[5], v[6]).normalized().toRotationMatrix();
  pose.translation() = fcl::Vector3d(v[0], v[1], v[2]);
  return pose;
}

struct Body {
  Pose at;
  std::unique_ptr<Object> object;
};

/// Reads a shape and the pose of its frame in its link's or the world's.
static Body read_body(std::istream& in) {
  std::string kind;
  in >> kind;
  std::shared_ptr<fcl::CollisionGeometryd> shape;
  double a = 0, b = 0, c = 0;
  if (kind == "box" && in >> a >> b >> c) shape = std::make_shared<fcl::Boxd>(a, b, c);
  if (kind == "sphere" && in >> a) shape = std::make_shared<fcl::Sphered>(a);
  if (kind == "cylinder" && in >> a >> b) shape = std::make_shared<fcl::Cylinderd>(a, b);
  if (kind == "capsule" && in >> a >> b) shape = std::make_shared<fcl::Capsuled>(a, b);
  if (kind == "mesh") {
    std::vector<fcl::Vector3d> points;
    std::vector<fcl::Triangle> faces;
    read_mesh(in, points, faces);
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    model->addSubModel(points, faces);
    model->endModel();
    shape = model;
  }
  if (!shape) fail("a box, sphere, cylinder, capsule or mesh expected, `" + kind + "` found");
  shape->computeLocalAABB();
  return {read_pose(in), std::make_unique<Object>(shape)};
}

static std::vector<Body> read_bodies(std::istream& in) {
  size_t count;
  if (!(in >> count)) fail("a number of bodies expected");
  std::vector<Body> bodies;
  for (size_t i = 0; i < count; ++i) bodies.push_back(read_body(in));
  return bodies;
}

struct Link {
  int parent;
  std::string kind;
  fcl::Vector3d axis;
  /// The joint's value is `multiplier` times that of the configuration at `value`, plus `offset`.
  int value;
  double multiplier, offset;
  Pose before, after, pose;
  std::vector<Body> bodies;
};

struct Range {
  double low, high, lever;
};

struct Scene {
  double resolution;
  std::string base;
  Pose stands;
  std::vector<Link> links;
  std::vector<Body> obstacles;
  std::vector<std::pair<int, int>> pairs;
  std::vector<Range> ranges;

  /// Puts the links where they stand at a configuration.
  void stand(const double* q) {
    for (Link& link : links) {
      if (link.parent < 0) {
        link.pose = base_pose(q);
      } else {
        link.pose = links[link.parent].pose * link.before * motion(link, q) * link.after;
      }
      for (Body& body : link.bodies) {
        body.object->setTransform(link.pose * body.at);
        body.object->computeAABB();
      }
    }
  }

  Pose base_pose(const double* q) const {
    Pose pose = Pose::Identity();
    if (base == "fixed") return stands;
    const bool planar = base == "translation-2d" || base == "rigid-2d";
    pose.translation() = fcl::Vector3d(q[0], q[1], planar ? 0 : q[2]);
    if (base == "rigid-2d") pose.linear() = Eigen::AngleAxisd(q[2], fcl::Vector3d::UnitZ()).toRotationMatrix();
    if (base == "rigid-3d") pose.linear() = fcl::Quaterniond(q[3], q[4], q[5], q[6]).toRotationMatrix();
    return pose;
  }

  static Pose motion(const Link& link, const double* q) {
    Pose pose = Pose::Identity();
    const double value = link.value < 0 ? 0 : link.multiplier * q[link.value] + link.offset;
    if (link.kind == "revolute") pose.linear() = Eigen::AngleAxisd(value, link.axis).toRotationMatrix();
    if (link.kind == "prismatic") pose.translation() = value * link.axis;
    if (link.kind == "spherical") {
      const double* r = q + link.value;
      pose.linear() = fcl::Quaterniond(r[0], r[1], r[2], r[3]).toRotationMatrix();
    }
    return pose;
  }

  static bool meet(const Body& a, const Body& b) {
    static const fcl::CollisionRequestd request(1, false);
    if (!a.object->getAABB().overlap(b.object->getAABB())) return false;
    fcl::CollisionResultd result;
    return fcl::collide(a.object.get(), b.object.get(), request, result) != 0;
  }

  /// Gives `take` every pair of bodies that must not meet and does: link, body, other link or −1, other body. It ends
  /// where `take` says so.
  template <class Take>
  void contacts(Take take) const {
    for (size_t i = 0; i < links.size(); ++i)
      for (size_t k = 0; k < links[i].bodies.size(); ++k)
        for (size_t o = 0; o < obstacles.size(); ++o)
          if (meet(links[i].bodies[k], obstacles[o]) && take(int(i), int(k), -1, int(o))) return;
    for (const auto& [i, j] : pairs)
      for (size_t k = 0; k < links[i].bodies.size(); ++k)
        for (size_t l = 0; l < links[j].bodies.size(); ++l)
          if (meet(links[i].bodies[k], links[j].bodies[l]) && take(i, int(k), j, int(l))) return;
  }
};

static Scene read_scene(const char* path) {
  std::ifstream in(path);
  Scene scene;
  size_t links, pairs, ranges;
  if (!(in >> scene.resolution >> scene.base)) fail("a scene expected");
  scene.stands = read_pose(in);
  in >> links;
  for (size_t i = 0; i < links && in; ++i) {
    Link link;
    in >> link.parent >> link.kind >> link.axis[0] >> link.axis[1] >> link.axis[2] >> link.value >> link.multiplier >> link.offset;
    link.before = read_pose(in);
    link.after = read_pose(in);
    link.bodies = read_bodies(in);
    scene.links.push_back(std::move(link));
  }
  scene.obstacles = read_bodies(in);
  for (Body& body : scene.obstacles) {
    body.object->setTransform(body.at);
    body.object->computeAABB();
  }
  in >> pairs;
  scene.pairs.resize(pairs);
  for (auto& [one, other] : scene.pairs) in >> one >> other;
  in >> ranges;
  scene.ranges.resize(ranges);
  for (Range& range : scene.ranges) in >> range.low >> range.high >> range.lever;
  if (!in) fail("the scene is cut off");
  return scene;
}

static int touching(Scene& scene, const char* configs) {
  std::ifstream in(configs);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<double> q;
    for (double value; words >> value;) q.push_back(value);
    scene.stand(q.data());
    std::string found;
    scene.contacts([&](int link, int body, int other, int second) {
      found += std::to_string(link) + "." + std::to_string(body) + ":";
      found += (other < 0 ? "" : std::to_string(other) + ".") + std::to_string(second) + " ";
      return false;
    });
    std::printf("%s\n", found.c_str());
  }
  return 0;
}

using Real = ob::RealVectorStateSpace;

struct Checker : ob::StateValidityChecker {
  Scene& scene;
  Checker(const ob::SpaceInformationPtr& si, Scene& scene) : ob::StateValidityChecker(si), scene(scene) {}
  bool isValid(const ob::State* state) const override {
    if (!si_->satisfiesBounds(state)) return false;
    scene.stand(state->as<Real::StateType>()->values);
    bool free = true;
    scene.contacts([&](int, int, int, int) { return !(free = false); });
    return free;
  }
};

struct Validator : ob::MotionValidator {
  const Scene& scene;
  mutable Interior interior;
  ob::State* between;
  int finer = 1;

  Validator(const ob::SpaceInformationPtr& si, const Scene& scene) : ob::MotionValidator(si), scene(scene), between(si->allocState()) {}
  ~Validator() override { si_->freeState(between); }

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    const double *p = a->as<Real::StateType>()->values, *q = b->as<Real::StateType>()->values;
    double farthest = 0;
    for (size_t i = 0; i < scene.ranges.size(); ++i) farthest += scene.ranges[i].lever * std::fabs(p[i] - q[i]);
    const int count = std::max(1, int(std::ceil(farthest / scene.resolution * finer)));
    return interior.free(count, [&](int step) {
      si_->getStateSpace()->interpolate(a, b, double(step) / count, between);
      return si_->isValid(between);
    }) && si_->isValid(b);
  }
  bool checkMotion(const ob::State* a, const ob::State* b, std::pair<ob::State*, double>&) const override { return checkMotion(a, b); }
};

static int solve(Scene& scene, const char* query, double limit, const char* path) {
  const size_t dofs = scene.ranges.size();
  auto space = std::make_shared<Real>(dofs);
  ob::RealVectorBounds bounds(dofs);
  for (size_t i = 0; i < dofs; ++i) {
    bounds.setLow(i, scene.ranges[i].low);
    bounds.setHigh(i, scene.ranges[i].high);
  }
  space->setBounds(bounds);
  auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<Checker>(si, scene));
  auto validator = std::make_shared<Validator>(si, scene);
  si->setMotionValidator(validator);
  si->setup();
  ob::ScopedState<Real> ends[2] = {ob::ScopedState<Real>(space), ob::ScopedState<Real>(space)};
  std::ifstream in(query);
  for (auto& end : ends)
    for (size_t i = 0; i < dofs; ++i) in >> end[i];
  if (!in) fail("two configurations expected");
  auto problem = std::make_shared<ob::ProblemDefinition>(si);
  problem->setStartAndGoalStates(ends[0], ends[1]);
  ompl::geometric::RRTConnect planner(si);
  planner.setProblemDefinition(problem);
  planner.setup();
  const double begun = cpu_seconds();
  const auto status = planner.solve(ob::PlannerTerminationCondition([&] { return cpu_seconds() - begun >= limit; }));
  const double seconds = cpu_seconds() - begun;
  const bool solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  bool passes = solved;
  std::ofstream out(path);
  out.precision(17);
  if (solved) {
    const auto& states = problem->getSolutionPath()->as<ompl::geometric::PathGeometric>()->getStates();
    validator->finer = FINER;
    for (size_t i = 0; i < states.size(); ++i) {
      if (i > 0) passes &= validator->checkMotion(states[i - 1], states[i]);
      for (size_t k = 0; k < dofs; ++k) out << states[i]->as<Real::StateType>()->values[k] << (k + 1 < dofs ? ' ' : '\n');
    }
  }
  std::printf("%.6f %d %d\n", seconds, solved, passes);
  return 0;
}

int main(int count, char** words) {
  const char* expected = "touching or solve expected, with what the first lines of robots.cpp say";
  if (count < 4) fail(expected);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const std::string mode = words[1];
  Scene scene = read_scene(words[2]);
  if (mode == "touching") return touching(scene, words[3]);
  if (mode == "solve" && count == 7) {
    ompl::RNG::setSeed(std::strtoul(words[4], nullptr, 10));
    return solve(scene, words[3], std::strtod(words[5], nullptr), words[6]);
  }
  fail(expected);
}
