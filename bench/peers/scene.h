// What the peers of bench/race.rs share: scenes and pairs as it writes them, and the order of steps.
#pragma once

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

[[noreturn]] inline void fail(const std::string& what) {
  std::cerr << "race: " << what << "\n";
  std::exit(2);
}

inline double cpu_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

/// Reads a mesh: points, and triangles of three indices each.
template <class Point, class Triangle>
void read_mesh(std::istream& in, std::vector<Point>& points, std::vector<Triangle>& triangles) {
  size_t vertices, faces;
  if (!(in >> vertices >> faces)) fail("a mesh expected");
  points.resize(vertices);
  for (auto& p : points) in >> p[0] >> p[1] >> p[2];
  for (size_t i = 0; i < faces; ++i) {
    size_t a, b, c;
    in >> a >> b >> c;
    triangles.emplace_back(a, b, c);
  }
  if (!in) fail("the mesh is cut off");
}

/// What stands in a scene before its two meshes, the obstacles' and the robot's.
struct Head {
  double low[3], high[3], resolution, radius;
};

inline Head read_head(std::istream& in) {
  Head head;
  for (double& value : head.low) in >> value;
  for (double& value : head.high) in >> value;
  if (!(in >> head.resolution >> head.radius)) fail("a scene expected");
  return head;
}

/// Reads pairs of configurations x y z qw qx qy qz with their numbers of steps.
template <class Take>
void read_pairs(const char* path, Take take) {
  std::ifstream in(path);
  double q[14];
  for (int steps;;) {
    for (double& value : q) in >> value;
    if (!(in >> steps)) return;
    take(q, q + 7, steps);
  }
}

/// Looks at the interior points of `steps` equal steps, the middle first as OMPL does.
struct Interior {
  std::vector<std::pair<int, int>> queue;

  /// `free` decides the point that lies so many steps along the motion.
  template <class Free>
  bool free(int steps, Free free) {
    if (steps < 2) return true;
    queue.assign(1, {1, steps - 1});
    for (size_t head = 0; head < queue.size(); ++head) {
      const auto [low, high] = queue[head];
      const int middle = (low + high) / 2;
      if (!free(middle)) return false;
      if (low < middle) queue.push_back({low, middle - 1});
      if (middle < high) queue.push_back({middle + 1, high});
    }
    return true;
  }
};

/// Decides all pairs, writes a verdict (1 free, 0 blocked) a line, and prints the CPU seconds.
template <class Pair, class Free>
int decide(const std::vector<Pair>& pairs, const char* verdicts, Free free) {
  std::vector<bool> found;
  const double begun = cpu_seconds();
  for (const auto& pair : pairs) found.push_back(free(pair));
  const double seconds = cpu_seconds() - begun;
  std::ofstream out(verdicts);
  for (bool verdict : found) out << verdict << "\n";
  std::cout << seconds << " " << pairs.size() << "\n";
  return 0;
}
