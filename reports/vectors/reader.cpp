// Compares a solver with the right answers: c++ -std=c++17 reader.cpp && ./a.out vectors.json 1e-9
// Put your own simulator in place of `solve`; this one knows free bodies, wheels, constant moments.
#include <fstream>
#include <iostream>
#include <regex>
#include <valarray>
#include <vector>
using Vector = std::valarray<double>;
// A question is a line; the numbers of a name are the first list after it.
Vector numbers(const std::string &line, const std::string &name) {
  const std::size_t begin = line.find('"' + name + "\":") + name.size() + 3;
  const std::string list = line.substr(begin, line.find("],\"", begin) - begin);
  const std::regex number("-?[0-9][-+.e0-9]*");
  std::vector<double> values;
  for (std::sregex_iterator at(list.begin(), list.end(), number), last; at != last; ++at)
    values.push_back(std::stod(at->str()));
  return Vector(values.data(), values.size());
}
Vector cross(const Vector &a, const Vector &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}double length(const Vector &v) { return std::sqrt((v * v).sum()); }
std::vector<Vector> solve(const std::string &line) {
  const Vector I = numbers(line, "inertia"), times = numbers(line, "times");
  const Vector moment = numbers(line, "moment"), rotor = numbers(line, "rotor");
  const Vector a{I[0], I[1], I[2]}, b{I[3], I[4], I[5]}, c{I[6], I[7], I[8]};
  const double volume = (a * cross(b, c)).sum();
  const auto rate = [&](const Vector &w) -> Vector {
    const Vector H = Vector{(a * w).sum(), (b * w).sum(), (c * w).sum()} + rotor;
    const Vector M = (cross(H, w) + moment) / volume;
    return M[0] * cross(b, c) + M[1] * cross(c, a) + M[2] * cross(a, b);
  };
  std::vector<Vector> rows{numbers(line, "omega")};
  for (std::size_t k = 1; k < times.size(); k++) {
    const double h = (times[k] - times[k - 1]) / 200;
    Vector w = rows.back();
    for (int step = 0; step < 200; step++) {
      const Vector p = rate(w), q = rate(w + h / 2 * p), r = rate(w + h / 2 * q);
      w += h / 6 * (p + 2.0 * q + 2.0 * r + rate(w + h * r));
    }
    rows.push_back(w);
  }
  return rows;
}
int main(int, char **words) {
  std::ifstream file(words[1]);
  int right = 0, wrong = 0;
  for (std::string line; std::getline(file, line);) {
    if (!std::regex_search(line.substr(0, 60), std::regex("\"(free|wheels|moment)\""))) continue;
    const Vector x = numbers(line, "w1"), y = numbers(line, "w2"), z = numbers(line, "w3");
    const std::vector<Vector> rows = solve(line);
    bool within = true;
    for (std::size_t k = 0; k < rows.size(); k++) {
      const Vector truth{x[k], y[k], z[k]};
      within &= length(rows[k] - truth) <= std::stod(words[2]) * length(truth);  // a NaN is not
    }
    (within ? right : wrong)++;
  }
  std::cout << right << " right, " << wrong << " wrong\n";
  return right > 0 && wrong == 0 ? 0 : 1;
}
