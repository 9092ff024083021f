// What acts on the rigid body of a question: moment, loads, damping, wheels, and states of one's own.
//
// It is acting.py in C++17, in the same words, with a reader of JSON, and may be copied beside a program of
// one's own:
//
//     Acting acting(question, [&] { return engine.state(); });
//     while (acting.t != elapsed) {
//       const double h = acting.step(elapsed, longest);
//       engine.step(acting.t, h, acting.moment);
//       acting.move(h);
//     }
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

using Vector = std::vector<double>;
using Known = std::map<std::string, double>;
using Moment = std::function<Vector(double, const Vector &)>;

// A JSON value: the text of a string or number, the entries of a list, or those of an object by name.
struct Json {
  std::string text;
  std::vector<Json> list;
  std::map<std::string, Json> names;

  bool has(const std::string &name) const { return names.count(name) > 0; }
  bool is_null() const { return text == "null"; }
  const Json &operator[](const std::string &name) const { return names.at(name); }

  static Json read(const std::string &document) {
    std::size_t at = 0;
    return value(document, at);
  }

 private:
  static void skip(const std::string &document, std::size_t &at) {
    at = document.find_first_not_of(" \t\r\n,:", at);
  }

  static Json value(const std::string &document, std::size_t &at) {
    Json made;
    skip(document, at);
    if (document[at] == '"') {
      made.text = quoted(document, at);
    } else if (document[at] == '[') {
      for (skip(document, ++at); document[at] != ']'; skip(document, at)) made.list.push_back(value(document, at));
      at++;
    } else if (document[at] == '{') {
      for (skip(document, ++at); document[at] != '}'; skip(document, at)) {
        const std::string name = quoted(document, at);
        made.names[name] = value(document, at);
      }
      at++;
    } else {
      const std::size_t end = document.find_first_of(" \t\r\n,]}", at);
      made.text = document.substr(at, end - at);
      at = end;
    }
    return made;
  }

  static std::string quoted(const std::string &document, std::size_t &at) {
    std::string made;
    for (at++; document[at] != '"'; at++) {
      if (document[at] == '\\') at++;
      made += document[at];
    }
    at++;
    return made;
  }
};

// The doubles of a number, vector or matrix of the question, row by row.
inline Vector floats(const Json &number) {
  if (number.has("hex")) return floats(number["hex"]);
  if (!number.text.empty()) return {std::strtod(number.text.c_str(), nullptr)};
  Vector made;
  for (const Json &entry : number.list)
    for (double value : floats(entry)) made.push_back(value);
  return made;
}

// The names in a list.
inline std::vector<std::string> words(const Json &list) {
  std::vector<std::string> made;
  for (const Json &entry : list.list) made.push_back(entry.text);
  return made;
}

// The steps between two switches: what is between `begin` and `end`.
class Piece {
 public:
  double begin, end;
  std::vector<int> moment, rates, taken, rotor;

  explicit Piece(const Json &piece)
      : begin(instant(piece["from"], -1)),
        end(instant(piece["to"], 1)),
        moment(places(piece, "moment")),
        rates(places(piece, "rates")),
        taken(places(piece, "values")),
        rotor(places(piece, "rotor")) {
    for (const Json &step : piece["steps"].list) steps_.push_back(prepared(step.list));
  }

  // The values of the steps at some places; `known` has the inputs by name.
  Vector values(const std::vector<int> &places, const Known &known) const {
    Vector done, made;
    for (const Step &step : steps_) done.push_back(value(step, done, known));
    for (int place : places) made.push_back(done[place]);
    return made;
  }

 private:
  struct Step {
    std::string word, name;
    double number = 0;
    std::vector<int> operands;
  };
  std::vector<Step> steps_;

  // An elapsed time by its text, a decimal or a/b.
  static double instant(const Json &text, int sign) {
    if (text.is_null()) return sign * std::numeric_limits<double>::infinity();
    const std::size_t slash = text.text.find('/');
    const double above = std::strtod(text.text.c_str(), nullptr);
    return slash == std::string::npos ? above : above / std::strtod(&text.text[slash + 1], nullptr);
  }

  static std::vector<int> places(const Json &piece, const std::string &name) {
    std::vector<int> made;
    if (piece.has(name))
      for (const Json &place : piece[name].list) made.push_back(std::atoi(place.text.c_str()));
    return made;
  }

  static Step prepared(const std::vector<Json> &list) {
    Step step{list[0].text, "", 0, {}};
    const bool has_number = step.word == "number" || step.word == "power";
    if (step.word == "input") step.name = list[1].text;
    if (has_number) step.number = std::strtod(list.back().text.c_str(), nullptr);
    const std::size_t end = step.word == "input" ? 1 : list.size() - 2 * has_number;
    for (std::size_t k = 1; k < end; k++) step.operands.push_back(std::atoi(list[k].text.c_str()));
    return step;
  }

  static double value(const Step &step, const Vector &done, const Known &known) {
    if (step.word == "number") return step.number;
    if (step.word == "input") return known.count(step.name) ? known.at(step.name) : std::nan("");
    Vector of;
    for (int k : step.operands) of.push_back(done[k]);
    return of.empty() ? std::acos(-1.0) : function(step.word, of, step.number);
  }

  static double function(const std::string &word, const Vector &of, double number) {
    using Function = double (*)(double);
    static const std::map<std::string, Function> functions = {
        {"sqrt", std::sqrt}, {"exp", std::exp},   {"log", std::log},   {"sin", std::sin},   {"cos", std::cos},
        {"tan", std::tan},   {"asin", std::asin}, {"acos", std::acos}, {"atan", std::atan}, {"sinh", std::sinh},
        {"cosh", std::cosh}, {"tanh", std::tanh}, {"abs", std::fabs},  {"floor", std::floor}};
    if (functions.count(word)) return functions.at(word)(of[0]);
    if (word == "power") return std::pow(of[0], number);
    if (word == "norm") return std::sqrt(std::inner_product(of.begin(), of.end(), of.begin(), 0.0));
    if (word == "sign") return (of[0] > 0) - (of[0] < 0);
    if (word == "step") return of[0] >= 0;
    if (word == "choose") return of[0] >= 0 ? of[1] : of[2];
    if (word == "+") return of[0] + of[1];
    if (word == "-") return of[0] - of[1];
    if (word == "*") return of[0] * of[1];
    if (word == "/") return of[0] / of[1];
    if (word == "min") return std::fmin(of[0], of[1]);
    if (word == "max") return std::fmax(of[0], of[1]);
    if (word == "atan2") return std::atan2(of[0], of[1]);
    return std::nan("");
  }
};

class Acting {
 public:
  double t = 0;
  Moment moment = [this](double at, const Vector &state) { return acting(at, state, advanced(at - t)); };

  Acting(const Json &question, std::function<Vector()> state)
      : state_(std::move(state)),
        attitude_(floats(question["initial"]["attitude"])),
        sign_(floats(question["time"]["elapsed"]).back() < 0 ? -1 : 1),
        inertia_(floats(question["body"]["inertia"])),
        constant_(floats(question["body"]["moment"])) {
    const Json &body = question["body"];
    if (body.has("rotor")) wheels_ = floats(body["rotor"]);
    if (body.has("damping")) damping_ = floats(body["damping"])[0];
    if (question.has("loads"))
      for (const Json &piece : question["loads"]["pieces"].list) pieces_.emplace_back(piece);
    if (question.has("states"))
      for (const Json &one : question["states"].list) add(one);
    if (question.has("instants"))
      for (const Json &one : question["instants"].list) instants_[floats(one.list[0])[0]] = words(one.list[1]);
    for (const auto &[at, names] : instants_) stops_.push_back(at);
    for (const Piece &piece : pieces_)
      if (std::isfinite(piece.end)) stops_.push_back(piece.end);
    arrive();
  }

  Acting(const Acting &) = delete;

  // The present states of one's own, by name.
  const Known &own() const { return values_; }

  // The length of the next step on the way to an instant, none longer than `longest`.
  double step(double until, double longest) {
    target_ = until;
    for (double stop : stops_)
      if ((stop - t) * sign_ > 0 && (target_ - stop) * sign_ > 0) target_ = stop;
    left_ = std::max(1L, std::lround(std::ceil(std::fabs(target_ - t) / longest - 1e-6)));
    return (target_ - t) / left_;
  }

  // The engine has made this step; states of one's own follow.
  void move(double step) {
    const double after = left_ == 1 ? target_ : t + step;
    for (const auto &[name, value] : advanced(after - t)) values_[name] = value;
    t = after;
    arrive();
  }

 private:
  std::function<Vector()> state_;
  // A quaternion and its negative are one attitude; loads read the one that goes on from the scene's.
  Vector attitude_;
  std::vector<std::string> moving_, held_;
  int sign_;
  Vector inertia_, constant_, wheels_ = {0, 0, 0}, begin_, stops_;
  double damping_ = 0, target_ = 0;
  long left_ = 1;
  std::vector<Piece> pieces_;
  const Piece *piece_ = nullptr;
  Known values_;
  std::map<double, std::vector<std::string>> instants_;

  void add(const Json &one) {
    const std::string name = one["name"].text;
    if (!one["start"].is_null()) values_[name] = floats(one["start"])[0];
    (one.has("rate") ? moving_ : held_).push_back(name);
  }

  // The moment in body axes, of all that acts: I w' = I w x w + this.
  Vector acting(double at, const Vector &state, const Known &own) const {
    const Vector omega(state.begin(), state.begin() + 3);
    Vector made = constant_;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) made[i] -= damping_ * inertia_[3 * i + j] * omega[j];
    if (pieces_.empty()) return plus(made, cross(wheels_, omega));
    const Known now = known(at, state, own);
    made = plus(made, piece_->values(piece_->moment, now));
    if (piece_->rotor.empty()) return plus(made, cross(wheels_, omega));
    return plus(plus(made, cross(piece_->values(piece_->rotor, now), omega)), reaction(at, now));
  }

  // Take the values that are due, all of them before any is set, and begin what begins here.
  void arrive() {
    const Vector state = state_();
    const double sign = nearness(state) < 0 ? -1 : 1;
    for (int i = 0; i < 4; i++) attitude_[i] = sign * state[3 + i];
    for (const Piece &piece : pieces_)
      if (sign_ > 0 ? piece.begin <= t && t < piece.end : piece.begin < t && t <= piece.end) piece_ = &piece;
    if (instants_.count(t)) {
      const Vector values = piece_->values(piece_->taken, known(t, state_(), {}));
      for (const std::string &name : instants_[t])
        values_[name] = values[std::find(held_.begin(), held_.end(), name) - held_.begin()];
    }
    // The engine's own numbers may change in the middle of a step.
    begin_ = state_();
  }

  // One's own continuous states a step later, by the classical method of Runge and Kutta for the body and
  // these states together.
  Known advanced(double step) const {
    if (moving_.empty() || step == 0) return {};
    Vector y = begin_;
    for (const std::string &name : moving_) y.push_back(values_.at(name));
    const auto moved = [&y](double h, const Vector &k) {
      Vector made = y;
      for (std::size_t i = 0; i < y.size(); i++) made[i] += h * k[i];
      return made;
    };
    const Vector k1 = rates(t, y), k2 = rates(t + step / 2, moved(step / 2, k1));
    const Vector k3 = rates(t + step / 2, moved(step / 2, k2)), k4 = rates(t + step, moved(step, k3));
    for (std::size_t i = 0; i < y.size(); i++) y[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return named(y);
  }

  // One's own continuous states behind omega and attitude, by name.
  Known named(const Vector &y) const {
    Known made;
    for (std::size_t k = 0; k < moving_.size(); k++) made[moving_[k]] = y[7 + k];
    return made;
  }

  // The rates of omega, attitude and one's own continuous states.
  Vector rates(double at, const Vector &y) const {
    const Vector omega(y.begin(), y.begin() + 3), state(y.begin(), y.begin() + 7);
    const Known own = named(y);
    const Vector I1 = row(0), I2 = row(1), I3 = row(2);
    const Vector minors[] = {cross(I2, I3), cross(I3, I1), cross(I1, I2)};
    const Vector momentum = {dot(I1, omega), dot(I2, omega), dot(I3, omega)};
    const Vector torque = plus(cross(momentum, omega), acting(at, state, own));
    const double p = y[3], q1 = y[4], q2 = y[5], q3 = y[6], a = y[0] / 2, b = y[1] / 2, c = y[2] / 2;
    Vector made(3);
    for (int j = 0; j < 3; j++)
      for (int i = 0; i < 3; i++) made[i] += minors[j][i] * torque[j] / dot(I1, minors[0]);
    made.insert(made.end(), {-q1 * a - q2 * b - q3 * c, p * a + q2 * c - q3 * b, p * b + q3 * a - q1 * c,
                             p * c + q1 * b - q2 * a});
    const Vector own_rates = piece_->values(piece_->rates, known(at, state, own));
    made.insert(made.end(), own_rates.begin(), own_rates.end());
    return made;
  }

  // A row of the inertia.
  Vector row(int i) const { return Vector(inertia_.begin() + 3 * i, inertia_.begin() + 3 * i + 3); }

  static double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  // All that steps may read, by name; the quaternion is unit.
  Known known(double at, const Vector &state, const Known &own) const {
    const double sign = nearness(state) < 0 ? -1 : 1;
    const double p = sign * state[3], x = sign * state[4], y = sign * state[5], z = sign * state[6];
    Known made = own;
    made.insert(values_.begin(), values_.end());
    made.insert({{"t", at}, {"w1", state[0]}, {"w2", state[1]}, {"w3", state[2]},
                 {"q0", p}, {"q1", x}, {"q2", y}, {"q3", z},
                 {"r11", 1 - 2 * (y * y + z * z)}, {"r12", 2 * (x * y - p * z)}, {"r13", 2 * (x * z + p * y)},
                 {"r21", 2 * (x * y + p * z)}, {"r22", 1 - 2 * (x * x + z * z)}, {"r23", 2 * (y * z - p * x)},
                 {"r31", 2 * (x * z - p * y)}, {"r32", 2 * (y * z + p * x)}, {"r33", 1 - 2 * (x * x + y * y)}});
    return made;
  }

  // The product of the quaternion of a state and the one before.
  double nearness(const Vector &state) const {
    return std::inner_product(attitude_.begin(), attitude_.end(), state.begin() + 3, 0.0);
  }

  // What the change of the momentum of wheels does to the body, -h'.
  Vector reaction(double at, const Known &now) const {
    const double momentary = std::ldexp(1.0, -13);
    const Vector rates = piece_->values(piece_->rates, now);
    const auto wheels = [&](double later) {
      Known moved = now;
      moved["t"] = at + later;
      for (std::size_t k = 0; k < moving_.size(); k++) moved[moving_[k]] += later * rates[k];
      return piece_->values(piece_->rotor, moved);
    };
    Vector made = wheels(-momentary);
    const Vector after = wheels(momentary);
    for (int i = 0; i < 3; i++) made[i] = (made[i] - after[i]) / (2 * momentary);
    return made;
  }

  static Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  static Vector plus(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
};
