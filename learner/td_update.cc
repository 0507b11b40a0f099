#include "learner/td_update.h"

#include <torch/torch.h>

#include <cmath>
#include <span>
#include <utility>

#include "learner/q_network.h"
#include "learner/td_loss.h"
#include "proto/failure.h"

namespace corridor::learner {
namespace {

torch::Tensor view(const std::vector<float>& values) {
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

}  // namespace

TdState initial_td_state(std::vector<float> parameters) {
  const std::vector<float> zeros(parameters.size(), 0.0f);
  return {parameters, parameters, zeros, zeros, 0};
}

struct TdUpdate::Impl {
  Impl(const NetworkShape& shape, const DqnSettings& settings, const std::string& where)
      : dqn(settings), device(where), online(shape, where), target(shape, where) {
    // Adam sees one parameter, the flat vector, whose gradient backward fills.
    torch::Tensor& flat = online.parameter_tensor();
    flat.mutable_grad() = online.gradient_tensor();
    adam = std::make_unique<torch::optim::Adam>(std::vector<torch::Tensor>{flat},
                                                torch::optim::AdamOptions().eps(dqn.adam_epsilon));
    // Adam makes its state in its first step; with a gradient of 0 that step moves nothing.
    adam->step();
  }

  torch::optim::AdamParamState& moments() const {
    return static_cast<torch::optim::AdamParamState&>(*adam->state().begin()->second);
  }

  DqnSettings dqn;
  torch::Device device;
  QNetwork online;
  QNetwork target;
  std::unique_ptr<torch::optim::Adam> adam;
  std::uint64_t updates = 0;
};

TdUpdate::TdUpdate(const NetworkShape& shape, const DqnSettings& dqn, const std::string& device,
                   const TdState& state)
    : impl_(std::make_unique<Impl>(shape, dqn, device)) {
  CORRIDOR_CHECK(state.mean_gradient.size() == shape.parameters() &&
                     state.mean_squared_gradient.size() == shape.parameters(),
                 "{} moments for {} parameters", state.mean_gradient.size(), shape.parameters());
  impl_->online.set_parameters(state.online);
  impl_->target.set_parameters(state.target);
  impl_->moments().exp_avg().copy_(view(state.mean_gradient));
  impl_->moments().exp_avg_sq().copy_(view(state.mean_squared_gradient));
  impl_->moments().step(static_cast<std::int64_t>(state.updates));
  impl_->updates = state.updates;
}

TdUpdate::~TdUpdate() = default;

TdUpdate::Result TdUpdate::update(const Batch& batch, double learning_rate) {
  const c10::InferenceMode no_autograd;
  const NetworkShape& shape = impl_->online.shape();
  const RowLayout layout{shape.observations};
  const auto size = static_cast<std::int64_t>(batch.weights.size());
  if (size == 0 || batch.rows.size() != batch.weights.size() * layout.stride()) {
    throw Failure(
        "a batch of {} rows has {} values, not {} a row: do all processes run the same "
        "build?",
        size, batch.rows.size(), layout.stride());
  }

  const torch::Tensor rows =  // [batch, stride]
      view(batch.rows).view({size, -1}).to(impl_->device);
  const torch::Tensor next = rows.narrow(1, shape.observations, shape.observations);
  const torch::Tensor target_next =  // [batch, action], as all below
      impl_->target.forward(next).to(torch::kCPU);
  const torch::Tensor online_next =
      impl_->dqn.double_q ? impl_->online.forward(next).to(torch::kCPU) : target_next;
  std::vector<torch::Tensor> layer_inputs;
  const torch::Tensor q =
      impl_->online.forward(rows.narrow(1, 0, shape.observations), &layer_inputs).to(torch::kCPU);

  // A batch of Q-values is small: in plain loops the loss costs a tenth of what LibTorch's
  // operations would.
  TdLoss loss = td_loss(batch.rows, layout, batch.weights,
                        {values(q), values(online_next), values(target_next)}, shape.actions,
                        {impl_->dqn.double_q, impl_->dqn.huber_delta});

  impl_->online.backward(layer_inputs, view(loss.q_gradient).view({size, -1}).to(impl_->device));
  const torch::Tensor& gradient = impl_->online.gradient_tensor();
  const double norm = gradient.norm().item<double>();
  if (norm > impl_->dqn.gradient_norm_max) gradient.mul_(impl_->dqn.gradient_norm_max / norm);
  static_cast<torch::optim::AdamOptions&>(impl_->adam->param_groups()[0].options())
      .lr(learning_rate);
  impl_->adam->step();

  ++impl_->updates;
  if (impl_->updates % static_cast<std::uint64_t>(impl_->dqn.target_copy_updates) == 0) {
    impl_->target.parameter_tensor().copy_(impl_->online.parameter_tensor());
  }
  return {loss.loss, loss.q_value, norm, std::move(loss.priorities)};
}

std::uint64_t TdUpdate::updates() const { return impl_->updates; }
std::vector<float> TdUpdate::parameters() const { return impl_->online.parameters(); }

TdState TdUpdate::state() const {
  return {impl_->online.parameters(), impl_->target.parameters(), copy(impl_->moments().exp_avg()),
          copy(impl_->moments().exp_avg_sq()), impl_->updates};
}

}  // namespace corridor::learner
