// Compares a solver with the right answers: c++ -std=c++17 reader.cpp && ./a.out vectors.json 1e-9
// Put your own simulator in place of `solve`; this one knows free bodies, wheels, constant moments.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <valarray>
#include <vector>
using Vector = std::valarray<double>;

// A question is a line; its numbers stand between what begins and what ends them.
Vector numbers(const std::string &line, const std::string &begin, const std::string &end) {
  std::size_t at = line.find(begin) + begin.size();
  const std::size_t last = line.find(end, at);
  std::vector<double> values;
  while ((at = line.find_first_of("-0123456789", at)) < last) {
    char *after;
    values.push_back(std::strtod(&line[at], &after));
    at = after - line.data();
  }
  return Vector(values.data(), values.size());
}
Vector given(const std::string &line, const std::string &name) {
  return numbers(line, '"' + name + "\":{\"text\":", ",\"hex\"");
}
Vector cross(const Vector &a, const Vector &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::vector<Vector> solve(const std::string &line) {
  const Vector inertia = given(line, "inertia"), times = given(line, "times");
  const Vector moment = given(line, "moment"), rotor = given(line, "rotor");
  const Vector a = inertia[std::slice(0, 3, 1)], b = inertia[std::slice(3, 3, 1)], c = inertia[std::slice(6, 3, 1)];
  const Vector bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const auto rate = [&](const Vector &w) -> Vector {
    const Vector H = Vector{(a * w).sum(), (b * w).sum(), (c * w).sum()} + rotor;
    const Vector M = cross(H, w) + moment;
    return Vector{(bc * M).sum(), (ca * M).sum(), (ab * M).sum()} / (a * bc).sum();
  };
  std::vector<Vector> rows{given(line, "omega")};
  for (std::size_t k = 1; k < times.size(); k++) {
    Vector w = rows.back();
    const double h = (times[k] - times[k - 1]) / 200;
    for (int step = 0; step < 200; step++) {
      const Vector k1 = rate(w), k2 = rate(w + h / 2 * k1), k3 = rate(w + h / 2 * k2), k4 = rate(w + h * k3);
      w += h / 6 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    rows.push_back(w);
  }
  return rows;
}
int main(int, char **words) {
  std::ifstream file(words[1]);
  int right = 0, wrong = 0, others = 0;
  for (std::string line; std::getline(file, line);) {
    ...
