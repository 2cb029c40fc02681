// The other side of the race: OMPL and FCL on the scenes that bench/race.rs writes.
//
//   race edges SCENE PAIRS VERDICTS   decides the pairs with FCL, in as many steps as the file says;
//                                     writes a verdict (1 free, 0 blocked) a line
//   race grow SCENE NODES K SEED      OMPL's PRM::growRoadmap to NODES nodes with K neighbours
//   race solve SCENE QUERY SEED LIMIT PLANNER PATH
//                                     OMPL's planner (prm, rrt-connect, kpiece, est, bit-star), from the first to the second
//                                     configuration of the file QUERY, within LIMIT CPU seconds; writes the
//                                     path, a configuration a line
//   race count SCENE PAIRS            prints how many steps OMPL cuts each pair into by itself
//   race distance SCENE CONFIGS       prints FCL's distance of the surfaces at each configuration, 0 where
//                                     they meet
//
// The first three print the CPU seconds that they took, and what they counted. Configurations are
// x y z qw qx qy qz. A motion is checked at the interior points of `steps` equal steps, like ours: in
// steps that carry no robot point farther than the scene's resolution.
//
// Build: g++ -O3 -march=x86-64 -std=c++17 race.cpp -I/usr/include/eigen3 -I/usr/include/ompl-1.5 -lompl -lfcl -lccd
#include "scene.h"

#include <fcl/fcl.h>
#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace ob = ompl::base;
using SE3 = ob::SE3StateSpace;
using Model = fcl::BVHModel<fcl::OBBRSSd>;

struct Scene : Head {
  std::shared_ptr<Model> world, robot;
};

static std::shared_ptr<Model> read_model(std::istream& in) {
  std::vector<fcl::Vector3d> points;
  std::vector<fcl::Triangle> faces;
  read_mesh(in, points, faces);
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(points, faces);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

static Scene read_scene(const char* path) {
  std::ifstream in(path);
  Scene scene{read_head(in), nullptr, nullptr};
  scene.world = read_model(in);
  scene.robot = read_model(in);
  return scene;
}

static fcl::Transform3d pose_of(const SE3::StateType* state) {
  const auto& q = state->rotation();
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  pose.translation() = fcl::Vector3d(state->getX(), state->getY(), state->getZ());
  return pose;
}

static bool collides(const Scene& scene, const SE3::StateType* state) {
  const fcl::Transform3d pose = pose_of(state);
  static const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  const auto world = fcl::Transform3d::Identity();
  return fcl::collide(scene.robot.get(), pose, scene.world.get(), world, request, result) != 0;
}

struct Checker : ob::StateValidityChecker {
  const Scene& scene;
  Checker(const ob::SpaceInformationPtr& si, const Scene& scene) : ob::StateValidityChecker(si), scene(scene) {}
  bool isValid(const ob::State* state) const override {
    return si_->satisfiesBounds(state) && !collides(scene, state->as<SE3::StateType>());
  }
};

/// OMPL divides by its own measure of a motion; this validator takes our number of steps.
struct Validator : ob::MotionValidator {
  const Scene& scene;
  const SE3& space;
  mutable Interior interior;
  mutable size_t asked = 0;
  SE3::StateType* between;

  Validator(const ob::SpaceInformationPtr& si, const Scene& scene)
      : ob::MotionValidator(si), scene(scene), space(*si->getStateSpace()->as<SE3>()), between(si->allocState()->as<SE3::StateType>()) {}
  ~Validator() override { si_->freeState(between); }

  int steps(const SE3::StateType* a, const SE3::StateType* b) const {
    const double x = b->getX() - a->getX(), y = b->getY() - a->getY(), z = b->getZ() - a->getZ();
    const auto &p = a->rotation(), &q = b->rotation();
    const double dot = std::fabs(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z);
    const double farthest = std::sqrt(x * x + y * y + z * z) + scene.radius * 2 * std::acos(std::min(1.0, dot));
    return std::max(1, int(std::ceil(farthest / scene.resolution)));
  }
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    ++asked;
    const int count = steps(a->as<SE3::StateType>(), b->as<SE3::StateType>());
    // Both ends are milestones.
    return interior.free(count, [&](int step) {
      space.interpolate(a, b, double(step) / count, between);
      return si_->isValid(between);
    });
  }
  bool checkMotion(const ob::State* a, const ob::State* b, std::pair<ob::State*, double>&) const override { return checkMotion(a, b); }
};

static void set(SE3::StateType* state, const double* q) {
  state->setXYZ(q[0], q[1], q[2]);
  auto& rotation = state->rotation();
  rotation.w = q[3];
  rotation.x = q[4];
  rotation.y = q[5];
  rotation.z = q[6];
}

struct Pair {
  SE3::StateType *a, *b;
  int steps;
};

static std::vector<Pair> pairs_of(const std::shared_ptr<SE3>& space, const char* path) {
  std::vector<Pair> all;
  const auto state = [&](const double* q) {
    auto* state = space->allocState()->as<SE3::StateType>();
    set(state, q);
    return state;
  };
  read_pairs(path, [&](const double* a, const double* b, int steps) { all.push_back({state(a), state(b), steps}); });
  return all;
}

static int race_edges(const Scene& scene, const std::shared_ptr<SE3>& space, const char* pairs, const char* verdicts) {
  auto* between = space->allocState()->as<SE3::StateType>();
  Interior interior;
  return decide(pairs_of(space, pairs), verdicts, [&](const Pair& pair) {
    return interior.free(pair.steps, [&](int step) {
      space->interpolate(pair.a, pair.b, double(step) / pair.steps, between);
      return !collides(scene, between);
    });
  });
}

/// The default: no step is longer than 1 % of the extent, of positions and of rotations apart.
static int race_count(const std::shared_ptr<SE3>& space, const char* pairs) {
  for (const auto& pair : pairs_of(space, pairs)) std::printf("%u\n", space->validSegmentCount(pair.a, pair.b));
  return 0;
}

static int race_distance(const Scene& scene, const std::shared_ptr<SE3>& space, const char* configs) {
  auto* state = space->allocState()->as<SE3::StateType>();
  std::ifstream in(configs);
  double q[7];
  for (;;) {
    for (double& value : q) in >> value;
    if (!in) return 0;
    set(state, q);
    double apart = 0;
    if (!collides(scene, state)) {
      fcl::DistanceResultd result;
      fcl::distance(scene.robot.get(), pose_of(state), scene.world.get(), fcl::Transform3d::Identity(), fcl::DistanceRequestd(), result);
      apart = result.min_distance;
    }
    std::printf("%.17g\n", apart);
  }
}

static int race_grow(const Scene& scene, const std::shared_ptr<SE3>& space, unsigned nodes, unsigned k) {
  auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<Checker>(si, scene));
  auto validator = std::make_shared<Validator>(si, scene);
  si->setMotionValidator(validator);
  si->setup();
  // Growing needs a problem, whatever it is.
  auto problem = std::make_shared<ob::ProblemDefinition>(si);
  ob::ScopedState<SE3> any(space);
  any.random();
  problem->setStartAndGoalStates(any, any);
  ompl::geometric::PRM prm(si);
  prm.setProblemDefinition(problem);
  prm.setMaxNearestNeighbors(k);
  prm.setup();
  const double begun = cpu_seconds();
  prm.growRoadmap(ob::PlannerTerminationCondition([&] { return prm.milestoneCount() >= nodes; }));
  const double seconds = cpu_seconds() - begun;
  std::printf("%.6f %lu %lu %zu\n", seconds, prm.milestoneCount(), prm.edgeCount(), validator->asked);
  return 0;
}

/// PRM::solve works in two threads, so its cost is the process's.
static double process_seconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

static int race_solve(const Scene& scene, const std::shared_ptr<SE3>& space, const char* query, double limit, const std::string& name, const char* path) {
  auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<Checker>(si, scene));
  si->setMotionValidator(std::make_shared<Validator>(si, scene));
  si->setup();
  ob::ScopedState<SE3> start(space), goal(space);
  std::ifstream in(query);
  double q[14];
  for (double& value : q) in >> value;
  if (!in) fail("two configurations expected");
  set(start.get(), q);
  set(goal.get(), q + 7);
  auto problem = std::make_shared<ob::ProblemDefinition>(si);
  problem->setStartAndGoalStates(start, goal);
  std::shared_ptr<ob::Planner> planner;
  if (name == "prm") planner = std::make_shared<ompl::geometric::PRM>(si);
  if (name == "rrt-connect") planner = std::make_shared<ompl::geometric::RRTConnect>(si);
  if (name == "kpiece") planner = std::make_shared<ompl::geometric::KPIECE1>(si);
  if (name == "est") planner = std::make_shared<ompl::geometric::EST>(si);
  if (name == "bit-star") {
    // Any path will do: without this BIT* would go on making the path shorter.
    auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(si);
    objective->setCostThreshold(objective->infiniteCost());
    problem->setOptimizationObjective(objective);
    planner = std::make_shared<ompl::geometric::BITstar>(si);
  }
  if (!planner) fail("prm, rrt-connect, kpiece, est or bit-star expected");
  planner->setProblemDefinition(problem);
  planner->setup();
  const double begun = process_seconds();
  const auto status = planner->solve(ob::PlannerTerminationCondition([&] { return process_seconds() - begun >= limit; }));
  const double seconds = process_seconds() - begun;
  const bool solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  std::ofstream out(path);
  out.precision(17);
  if (solved) {
    const auto& states = problem->getSolutionPath()->as<ompl::geometric::PathGeometric>()->getStates();
    for (const auto* any : states) {
      const auto* state = any->as<SE3::StateType>();
      const auto& q = state->rotation();
      out << state->getX() << ' ' << state->getY() << ' ' << state->getZ() << ' ' << q.w << ' ' << q.x << ' ' << q.y << ' ' << q.z << '\n';
    }
  }
  ob::PlannerData data(si);
  planner->getPlannerData(data);
  std::printf("%.6f %u %d\n", seconds, data.numVertices(), solved);
  return 0;
}

int main(int count, char** words) {
  const char* expected = "edges, grow, solve, count or distance expected, with what the first lines of race.cpp say";
  if (count < 4) fail(expected);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const std::string mode = words[1];
  const Scene scene = read_scene(words[2]);
  auto space = std::make_shared<SE3>();
  ob::RealVectorBounds bounds(3);
  for (int i = 0; i < 3; ++i) {
    bounds.setLow(i, scene.low[i]);
    bounds.setHigh(i, scene.high[i]);
  }
  space->setBounds(bounds);
  space->setup();
  if (mode == "count") return race_count(space, words[3]);
  if (mode == "distance") return race_distance(scene, space, words[3]);
  if (mode == "edges" && count == 5) return race_edges(scene, space, words[3], words[4]);
  if (mode == "grow" && count == 6) {
    ompl::RNG::setSeed(std::strtoul(words[5], nullptr, 10));
    return race_grow(scene, space, std::atoi(words[3]), std::atoi(words[4]));
  }
  if (mode == "solve" && count == 8) {
    ompl::RNG::setSeed(std::strtoul(words[4], nullptr, 10));
    return race_solve(scene, space, words[3], std::strtod(words[5], nullptr), words[6], words[7]);
  }
  fail(expected);
}
