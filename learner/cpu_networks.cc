#include "learner/adam.h"
#include "learner/dense_passes.h"
#include "learner/td_networks.h"

namespace corridor::learner {
namespace {

class CpuNetworks : public TdNetworks {
 public:
  CpuNetworks(const NetworkShape& shape, const DqnSettings& dqn, const TdState& state)
      : shape_(shape),
        dqn_(dqn),
        state_(state),
        gradient_(shape.parameters()),
        online_pass_(shape),
        online_next_pass_(shape),
        target_next_pass_(shape) {}

  BatchQValues forward(std::span<const float> rows, int batch) override {
    const auto stride = static_cast<int>(RowLayout{shape_.observations}.stride());
    const float* next = rows.data() + shape_.observations;
    BatchQValues q;
    q.target_next = target_next_pass_.forward(state_.target, next, stride, batch);
    if (dqn_.double_q) {
      q.online_next = online_next_pass_.forward(state_.online, next, stride, batch);
    }
    q.online = online_pass_.forward(state_.online, rows.data(), stride, batch);
    return q;
  }

  double step(std::span<const float> q_gradient, double learning_rate) override {
    online_pass_.backward(state_.online, q_gradient, gradient_);
    const double size = norm(gradient_);
    const double scale = size > dqn_.gradient_norm_max ? dqn_.gradient_norm_max / size : 1.0;
    adam_step(state_.online, gradient_, {state_.mean_gradient, state_.mean_squared_gradient},
              static_cast<float>(scale), learning_rate, dqn_.adam_epsilon, ++state_.updates);
    return size;
  }

  void copy_to_target() override { state_.target = state_.online; }

  std::vector<float> parameters() const override { return state_.online; }

  TdState state() const override { return state_; }

 private:
  NetworkShape shape_;
  DqnSettings dqn_;
  TdState state_;
  std::vector<float> gradient_;
  DensePasses online_pass_;
  DensePasses online_next_pass_;
  DensePasses target_next_pass_;
};

}  // namespace

std::unique_ptr<TdNetworks> cpu_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                         const TdState& state) {
  return std::make_unique<CpuNetworks>(shape, dqn, state);
}

}  // namespace corridor::learner
