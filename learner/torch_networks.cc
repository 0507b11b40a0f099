#include <torch/torch.h>

#include <utility>

#include "learner/td_networks.h"
#include "learner/torch_q_network.h"

namespace corridor::learner {
namespace {

torch::Tensor view(std::span<const float> values) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size())});
}

std::vector<float> copy(const torch::Tensor& tensor) {
  const torch::Tensor host = tensor.to(torch::kCPU);
  return {host.data_ptr<float>(), host.data_ptr<float>() + host.numel()};
}

std::span<const float> values(const torch::Tensor& host) {
  return {host.data_ptr<float>(), static_cast<std::size_t>(host.numel())};
}

class TorchNetworks : public TdNetworks {
 public:
  TorchNetworks(const NetworkShape& shape, const DqnSettings& dqn, Device device,
                const TdState& state)
      : shape_(shape),
        dqn_(dqn),
        device_(name_of(device)),
        online_(shape, device),
        target_(shape, device) {
    // Adam sees one parameter, the flat vector. It makes its state in its first step; with a
    // gradient of 0 that step moves nothing.
    torch::Tensor& flat = online_.parameter_tensor();
    flat.set_requires_grad(true);
    flat.mutable_grad() = torch::zeros_like(flat);
    adam_ = std::make_unique<torch::optim::Adam>(std::vector<torch::Tensor>{flat},
                                                 torch::optim::AdamOptions().eps(dqn.adam_epsilon));
    adam_->step();
    online_.set_parameters(state.online);
    target_.set_parameters(state.target);
    moments().exp_avg().copy_(view(state.mean_gradient));
    moments().exp_avg_sq().copy_(view(state.mean_squared_gradient));
    moments().step(static_cast<std::int64_t>(state.updates));
  }

  BatchQValues forward(std::span<const float> rows, int batch) override {
    const torch::Tensor all =  // [batch, stride]
        view(rows).view({batch, -1}).to(device_);
    const torch::Tensor next = all.narrow(1, shape_.observations, shape_.observations);
    {
      const torch::NoGradGuard no_gradient;
      target_next_ = target_.forward(next).to(torch::kCPU).contiguous();
      if (dqn_.double_q) online_next_ = online_.forward(next).to(torch::kCPU).contiguous();
    }
    online_q_ = online_.forward(all.narrow(1, 0, shape_.observations));
    host_q_ = online_q_.detach().to(torch::kCPU).contiguous();
    BatchQValues q;
    q.online = values(host_q_);
    q.target_next = values(target_next_);
    if (dqn_.double_q) q.online_next = values(online_next_);
    return q;
  }

  double step(std::span<const float> q_gradient, double learning_rate) override {
    torch::Tensor& flat = online_.parameter_tensor();
    flat.mutable_grad().zero_();
    online_q_.backward(view(q_gradient).view(online_q_.sizes()).to(device_));
    const torch::NoGradGuard no_gradient;
    torch::Tensor& gradient = flat.mutable_grad();
    const double size = gradient.norm().item<double>();
    if (size > dqn_.gradient_norm_max) gradient.mul_(dqn_.gradient_norm_max / size);
    static_cast<torch::optim::AdamOptions&>(adam_->param_groups()[0].options()).lr(learning_rate);
    adam_->step();
    return size;
  }

  void copy_to_target() override {
    const torch::NoGradGuard no_gradient;
    target_.parameter_tensor().copy_(online_.parameter_tensor());
  }

  std::vector<float> parameters() const override { return online_.parameters(); }

  TdState state() const override {
    return {online_.parameters(), target_.parameters(), copy(moments().exp_avg()),
            copy(moments().exp_avg_sq()), static_cast<std::uint64_t>(moments().step())};
  }

 private:
  torch::optim::AdamParamState& moments() const {
    return static_cast<torch::optim::AdamParamState&>(*adam_->state().begin()->second);
  }

  NetworkShape shape_;
  DqnSettings dqn_;
  torch::Device device_;
  QNetwork online_;
  QNetwork target_;
  std::unique_ptr<torch::optim::Adam> adam_;

  // Of the last forward pass; all but online_q_ on the host.
  torch::Tensor online_q_;
  torch::Tensor host_q_;
  torch::Tensor online_next_;
  torch::Tensor target_next_;
};

}  // namespace

std::unique_ptr<TdNetworks> torch_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                           Device device, const TdState& state) {
  return std::make_unique<TorchNetworks>(shape, dqn, device, state);
}

}  // namespace corridor::learner
