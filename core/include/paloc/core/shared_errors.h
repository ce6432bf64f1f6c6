#pragma once

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Information of a least-squares estimate whose residuals share errors that it does not know of.
///
/// The residuals are r = J delta + e + B beta with independent e ~ N(0, D) and shared beta ~ N(0,
/// S). With `independent` H = J^T D^-1 J, the information if there were no beta, and `spread` G S
/// G^T, G = J^T D^-1 B, the covariance that beta gives to the gradient, the estimate's
///
///   covariance  = H^-1 + H^-1 G S G^T H^-1,      information = H (H + G S G^T)^-1 H.
///
/// Generalized least squares, J^T (D + B S B^T)^-1 J, would be the better estimate if D, B and S
/// were right. They are rough, and it then follows the few residuals that say most about
/// differences between shared errors: so these are considered, not estimated (the Schmidt or
/// "consider" covariance: Jazwinski, "Stochastic Processes and Filtering Theory", 1970,
/// section 8.4).
///
/// Both matrices must be positive semidefinite, the spread zero where the information is; what H
/// does not know stays unknown.
PALOC_EXPORT Mat6 informationUnderSharedErrors(const Mat6& independent, const Mat6& spread);

/// Z = H (H + G S G^T)^-1, of which the information above is Z H: an error that changes the
/// gradient of the estimate by g changes that of a factor with this information by Z g. What H does
/// not know must not be in g.
PALOC_EXPORT Mat6 gainUnderSharedErrors(const Mat6& independent, const Mat6& spread);

}  // namespace paloc
