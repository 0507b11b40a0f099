#include <utility>

#include "learner/adam.h"
#include "learner/dense_passes.h"
#include "learner/td_networks.h"
#include "learner/torch_q_network.h"

namespace corridor::learner {
namespace {

class CpuNetworks : public TdNetworks {
 public:
  CpuNetworks(const NetworkShape& shape, const DqnSettings& dqn, const TdState& state)
      : shape_(shape),
        dqn_(dqn),
        online_(shape, Device::kCpu),
        target_(shape, Device::kCpu),
        gradient_(shape.parameters()),
        mean_gradient_(state.mean_gradient),
        mean_squared_gradient_(state.mean_squared_gradient),
        steps_(state.updates),
        online_pass_(shape),
        online_next_pass_(shape),
        target_next_pass_(shape) {
    online_.set_parameters(state.online);
    target_.set_parameters(state.target);
  }

  BatchQValues forward(std::span<const float> rows, int batch) override {
    const auto stride = static_cast<int>(RowLayout{shape_.observations}.stride());
    const float* next = rows.data() + shape_.observations;
    BatchQValues q;
    q.target_next = target_next_pass_.forward(target_.values(), next, stride, batch);
    if (dqn_.double_q) {
      q.online_next = online_next_pass_.forward(online_.values(), next, stride, batch);
    }
    q.online = online_pass_.forward(online_.values(), rows.data(), stride, batch);
    return q;
  }

  double step(std::span<const float> q_gradient, double learning_rate) override {
    online_pass_.backward(online_.values(), q_gradient, gradient_);
    const double size = norm(gradient_);
    const double scale = size > dqn_.gradient_norm_max ? dqn_.gradient_norm_max / size : 1.0;
    adam_step(online_.values(), gradient_, {mean_gradient_, mean_squared_gradient_},
              static_cast<float>(scale), learning_rate, dqn_.adam_epsilon, ++steps_);
    return size;
  }

  void copy_to_target() override { target_.set_parameters(online_.values()); }

  std::vector<float> parameters() const override { return online_.parameters(); }

  TdState state() const override {
    return {online_.parameters(), target_.parameters(), mean_gradient_, mean_squared_gradient_,
            steps_};
  }

 private:
  NetworkShape shape_;
  DqnSettings dqn_;
  QNetwork online_;
  QNetwork target_;
  std::vector<float> gradient_;
  std::vector<float> mean_gradient_;
  std::vector<float> mean_squared_gradient_;
  std::uint64_t steps_;
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
