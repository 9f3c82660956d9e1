#include "moclean/backend/method.hpp"

namespace moclean {

bool accepts_missing(const Method& method) {
  return std::visit(
      []<class M>(const M&) {
        return requires { M::accepts_missing; };
      },
      method);
}

bool takes_prior(const Method& method) {
  return std::visit(
      []<class M>(const M&) {
        return requires { M::takes_prior; };
      },
      method);
}

bool tells_trust(const Method& method) { return std::holds_alternative<MatrixNormal>(method); }

}  // namespace moclean
