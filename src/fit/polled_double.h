// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/context.h"

#include <Eigen/Core>
#include <cmath>

namespace bot2nurbs {

//! A double that makes Eigen's sparse Cholesky factorisation stop when a context is cancelled.
//!
//! The factorisation of a large fit takes longer than a cancelled call may, and Eigen has no way to
//! interrupt it. But it compares every pivot with zero and gives up when they are equal: that one
//! comparison polls, and a cancelled context makes every pivot zero.
class PolledDouble {
public:
    PolledDouble() = default;
    PolledDouble(double value) : value_(value) {} // NOLINT: numbers convert
    explicit operator double() const { return value_; }

    //! Polls the context for comparisons on this thread as long as it lives.
    class Scope {
    public:
        explicit Scope(const Context& context) { context_ = &context; }
        ~Scope() { context_ = nullptr; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
    };

    PolledDouble& operator+=(PolledDouble b) { return value_ += b.value_, *this; }
    PolledDouble& operator-=(PolledDouble b) { return value_ -= b.value_, *this; }
    PolledDouble& operator*=(PolledDouble b) { return value_ *= b.value_, *this; }
    PolledDouble& operator/=(PolledDouble b) { return value_ /= b.value_, *this; }
    friend PolledDouble operator+(PolledDouble a, PolledDouble b) { return a.value_ + b.value_; }
    friend PolledDouble operator-(PolledDouble a, PolledDouble b) { return a.value_ - b.value_; }
    friend PolledDouble operator*(PolledDouble a, PolledDouble b) { return a.value_ * b.value_; }
    friend PolledDouble operator/(PolledDouble a, PolledDouble b) { return a.value_ / b.value_; }
    friend PolledDouble operator-(PolledDouble a) { return -a.value_; }
    friend bool operator==(PolledDouble a, PolledDouble b)
    {
        return a.value_ == b.value_ || (context_ && context_->cancelled());
    }
    friend bool operator!=(PolledDouble a, PolledDouble b) { return a.value_ != b.value_; }
    friend bool operator<(PolledDouble a, PolledDouble b) { return a.value_ < b.value_; }
    friend bool operator>(PolledDouble a, PolledDouble b) { return a.value_ > b.value_; }
    friend bool operator<=(PolledDouble a, PolledDouble b) { return a.value_ <= b.value_; }
    friend bool operator>=(PolledDouble a, PolledDouble b) { return a.value_ >= b.value_; }
    friend PolledDouble sqrt(PolledDouble a) { return std::sqrt(a.value_); }

private:
    double value_ = 0.0;
    static thread_local const Context* context_;
};

inline thread_local const Context* PolledDouble::context_ = nullptr;

} // namespace bot2nurbs

namespace Eigen {

template <> struct NumTraits<bot2nurbs::PolledDouble> : NumTraits<double> {
    using Real = bot2nurbs::PolledDouble;
    using NonInteger = bot2nurbs::PolledDouble;
    using Nested = bot2nurbs::PolledDouble;
    using Literal = bot2nurbs::PolledDouble;
};

} // namespace Eigen
