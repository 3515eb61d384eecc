#include "tartan_calib/solver/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "normal_equations.h"
#include "schur.h"
#include "solver_choice.h"
#include "sparse.h"

namespace tartan_calib::solver {
namespace {

constexpr double kMinDamping = 1e-12;  ///< keeps undetermined directions solvable
constexpr double kMaxDamping = 1e12;
constexpr double kDampingDecrease = 0.3;
constexpr double kDampingIncrease = 3.0;  ///< grows with every rejection in a row
constexpr int kMaxCorrections = 2;
constexpr int kPatience = 10;           ///< iterations that together must gain something
constexpr double kMaxRise = 10.0;       ///< a step that raises the cost by more is beyond correction
constexpr double kGoodGain = 0.5;       ///< actual over promised change of cost from which on damping falls
constexpr double kSmallPromise = 1e-3;  ///< of the cost: a step close to a minimum
constexpr double kMinShare = 0.25;      ///< a step that has to be shortened to less is left to corrections and damping

/// A step with what the quadratic model promises.
struct Candidate {
  Step step;
  double slope = 0.0;     ///< of the cost, along the step
  double promised = 0.0;  ///< decrease of the cost
};

Step scaled(Step step, double share) {
  step.shared *= share;
  for (BlockVector& block : step.blocks) {
    block *= share;
  }
  return step;
}

class Minimizer {
 public:
  Minimizer(BlockProblem& problem, const Options& options) : problem_(problem), options_(options) {}

  Summary run() {
    linearize();
    use_sparse_ = useSparse();
    summary_.initial_cost = equations_.cost;
    last_look_ = {0, equations_.cost};
    while (!is_finished_) {
      iterate();
    }
    summary_.final_cost = equations_.cost;
    return summary_;
  }

 private:
  void linearize() { equations_ = linearizeAll(problem_, options_.num_threads); }

  void finish(Status status) {
    summary_.status = status;
    is_finished_ = true;
  }

  void iterate() {
    const std::optional<Candidate> candidate = propose(equations_);
    if (candidate && candidate->promised <= tolerance()) {
      tryUndamped();
    } else if (!candidate) {
      failed_promise_ = std::numeric_limits<double>::infinity();  // who knows
      reject();
    } else if (!tryStep(*candidate)) {
      reject();
    }
  }

  double tolerance() const { return std::max(options_.absolute_tolerance, options_.relative_tolerance * equations_.cost); }

  /// Damping makes any promise small, so that only an almost undamped step can tell that there is nothing left to gain.
  void tryUndamped() {
    if (damping_ <= options_.newton_damping) {
      finish(Status::kConverged);
    } else if (undamped_failed_) {
      giveUp();
    } else {
      damping_ = options_.newton_damping;
    }
  }

  /// No step lowers the cost.
  void giveUp() { finish(failed_promise_ <= negligible() ? Status::kConverged : Status::kStalled); }

  double negligible() const { return std::max(tolerance(), options_.negligible_ratio * equations_.cost); }

  /// Whether the last iterations together have gained nothing that counts.
  bool isCrawling() {
    if (summary_.iterations - last_look_.iteration < kPatience) {
      return false;
    }
    const double gained = last_look_.cost - equations_.cost;
    last_look_ = {summary_.iterations, equations_.cost};
    return gained <= negligible();
  }

  bool tryStep(const Candidate& candidate) {
    problem_.save();
    problem_.move(candidate.step);
    double cost = totalCost(problem_, options_.num_threads);
    if (!(equations_.cost - cost >= kGoodGain * candidate.promised)) {
      cost = costOfBetterStep(candidate, cost);
    }
    if (!(cost < equations_.cost)) {
      problem_.restore();
      failed_promise_ = std::max(failed_promise_, candidate.promised);
      return false;
    }
    if (equations_.cost - cost > kGoodGain * candidate.promised) {
      damping_ = std::max(kMinDamping, damping_ * kDampingDecrease);
    }
    accept();
    return true;
  }

  /// For a step that gains too little.
  double costOfBetterStep(const Candidate& candidate, double cost) {
    if (!(cost < equations_.cost)) {
      return costAfterCorrection(cost);
    }
    return candidate.promised < kSmallPromise * equations_.cost ? costAfterShortening(candidate, cost) : cost;
  }

  /// Close to a minimum with residuals such a step is too long: where J'J is less than the cost's true curvature,
  /// Gauss-Newton steps swing about the minimum. The parabola through the cost here, its slope and the cost there has its
  /// own near by.
  double costAfterShortening(const Candidate& candidate, double cost) {
    const double curvature = 2.0 * (cost - equations_.cost - candidate.slope);
    const double share = -candidate.slope / curvature;
    if (!(share > kMinShare)) {
      return cost;
    }
    problem_.restore();
    problem_.move(scaled(candidate.step, share));
    const double shortened = totalCost(problem_, options_.num_threads);
    if (shortened < cost) {
      return shortened;
    }
    problem_.restore();
    problem_.move(candidate.step);
    return cost;
  }

  /// Where unknowns trade off against each other, the cost is a narrow curved valley: a long step along it ends up on its
  /// side, another from there back on its floor. Without the second only short ones would lower the cost.
  double costAfterCorrection(double cost) {
    for (int i = 0; i < kMaxCorrections && !(cost < equations_.cost) && cost < kMaxRise * equations_.cost; ++i) {
      const std::optional<Candidate> correction = propose(linearizeAll(problem_, options_.num_threads));
      if (!correction) {
        return cost;
      }
      problem_.move(correction->step);
      cost = totalCost(problem_, options_.num_threads);
    }
    return cost;
  }

  void accept() {
    increase_ = kDampingIncrease;
    undamped_failed_ = false;
    failed_promise_ = 0.0;
    linearize();
    ++summary_.iterations;
    if (options_.progress && !options_.progress(summary_.iterations, equations_.cost)) {
      finish(Status::kCancelled);
    } else if (isCrawling()) {
      finish(Status::kConverged);
    } else if (summary_.iterations >= options_.max_iterations) {
      finish(Status::kMaxIterations);
    }
  }

  void reject() {
    undamped_failed_ = undamped_failed_ || damping_ <= options_.newton_damping;
    damping_ *= increase_;
    increase_ *= kDampingIncrease;
    if (damping_ > kMaxDamping) {
      giveUp();
    }
  }

  std::optional<Step> solve(const NormalEquations& equations, const Prescribed& prescribed) const {
    return use_sparse_ ? solveSparse(equations, damping_, prescribed)
                       : solveSchur(equations, damping_, prescribed, options_.num_threads);
  }

  bool useSparse() const {
    return options_.linear_solver == LinearSolver::kSparse ||
           (options_.linear_solver == LinearSolver::kAuto && isSparseFaster(equations_));
  }

  /// The damped step within the limits: unknowns that would pass a limit are sent to it, and the others solved for anew.
  std::optional<Candidate> propose(const NormalEquations& equations) const {
    const StepLimits limits = problem_.stepLimits();
    Prescribed prescribed = holdActiveBounds(equations, limits);
    while (true) {
      std::optional<Step> step = solve(equations, prescribed);
      if (!step || !step->shared.allFinite()) {
        return std::nullopt;
      }
      if (!prescribeViolations(*step, limits, prescribed)) {
        const Prediction prediction = predict(equations, *step);
        return Candidate{std::move(*step), prediction.slope, -prediction.change()};
      }
    }
  }

  static bool prescribeViolations(const Step& step, const StepLimits& limits, Prescribed& prescribed) {
    bool is_violated = false;
    for (const int i : prescribed.freeIndices()) {
      const double within = std::clamp(step.shared(i), limits.lower(i), limits.upper(i));
      if (within != step.shared(i)) {
        prescribed.is_prescribed[static_cast<std::size_t>(i)] = true;
        prescribed.step(i) = within;
        is_violated = true;
      }
    }
    return is_violated;
  }

  BlockProblem& problem_;
  const Options& options_;
  NormalEquations equations_;
  Summary summary_;
  double damping_ = options_.initial_damping;
  double increase_ = kDampingIncrease;
  bool use_sparse_ = false;
  bool undamped_failed_ = false;
  struct Look {
    int iteration = 0;
    double cost = 0.0;
  } last_look_;
  double failed_promise_ = 0.0;  ///< largest one of the steps rejected since the last success
  bool is_finished_ = false;
};

}  // namespace

Summary minimize(BlockProblem& problem, const Options& options) { return Minimizer(problem, options).run(); }

}  // namespace tartan_calib::solver
