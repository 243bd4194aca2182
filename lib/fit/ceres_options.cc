#include "fit/ceres_options.h"

#include <glog/logging.h>

namespace fettle {

ceres::Solver::Options quiet_dense_qr()
{
    FLAGS_minloglevel = google::GLOG_FATAL;
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    return options;
}

} // namespace fettle
