#include "cuda/resident.hpp"

#include <cstring>
#include <utility>

namespace innersphere::device {

bool Resident::isFor(const PreparedQuery& query, Goal goal) const {
  return launched_ && goal == goal_ && query.grid_a == models_[0] && query.grid_b == models_[1] &&
         query.grid_a->version() == versions_[0] && query.grid_b->version() == versions_[1];
}

void Resident::ask(const PreparedQuery& prepared, const Query& query, Goal goal, const Batch& batch,
                   const Device& device) {
  const volatile HostSignal& signal = *batch.signal;
  if (isFor(prepared, goal) && signal.left != mailbox_.number) {
    batch_.run = batch.run;
    write(batch.run, kAsk, &query);
    return;
  }
  // The kernel before may still have to read that it should leave, so the question goes elsewhere.
  questions_.reserve(2 * kQuestionHalves);
  question_ = questions_.data() + (question_ == questions_.data() ? kQuestionHalves : 0);
  relay_.reserve(kRelays * kQuestionHalves);
  sums_.reserve(2 * kSumCopies);
  counters_.reserve(2);
  models_[0] = prepared.grid_a;
  models_[1] = prepared.grid_b;
  for (int side = 0; side < 2; ++side) versions_[side] = models_[side]->version();
  goal_ = goal;
  clusters_ = prepared.setup.a.cluster_count + prepared.setup.b.cluster_count;
  batch_ = batch;
  batch_.sums = sums_.data();
  batch_.counters = counters_.data();
  mailbox_ = {{query.grids[0], query.grids[1]},
              question_,
              relay_.data(),
              mailbox_.number,
              static_cast<unsigned long long>(1e9 * device.resident_seconds)};
  write(batch.run, kAsk, &query);
  launch(device);
}

void Resident::launch(const Device& device) {
  ++mailbox_.number;
  INNERSPHERE_CUDA(
      cudaMemsetAsync(relay_.data(), 0, kRelays * kQuestionHalves * sizeof(long long), device.stream));
  INNERSPHERE_CUDA(cudaMemsetAsync(sums_.data(), 0, 2 * kSumCopies * sizeof(DeviceSums), device.stream));
  INNERSPHERE_CUDA(cudaMemsetAsync(counters_.data(), 0, 2 * sizeof(Counters), device.stream));
  launchResident(goal_, batch_, mailbox_, clusters_, device.processors, device.stream);
  launched_ = true;
}

bool Resident::dismiss() {
  if (!std::exchange(launched_, false)) return false;
  write(batch_.run + 1, kLeave, nullptr);
  return true;
}

void Resident::write(unsigned run, unsigned command, const Query* query) {
  volatile unsigned long long* const halves = question_;
  const unsigned long long above = static_cast<unsigned long long>(run) << 32;
  for (unsigned i = kQuestionHalves - 1; i > 0; --i) {
    unsigned word = 0;
    if (query) std::memcpy(&word, reinterpret_cast<const char*>(query) + (i - 1) * sizeof word, sizeof word);
    halves[i] = above | word;
  }
  halves[0] = above | command;
}

}  // namespace innersphere::device
