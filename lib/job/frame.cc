#include "job/frame.h"

#include <utility>

namespace fettle::job {

bool must_be_moved(cloud::Frame frame, const Job& job) { return job.T_part_job && frame == cloud::Frame::part; }

void move_to_job_frame(cloud::Cloud& cloud, const Job& job)
{
    if (!must_be_moved(cloud.frame, job)) return;
    cloud = cloud::transformed(std::move(cloud), job.T_part_job->inverse().matrix(), 1);
    cloud.frame = cloud::Frame::job;
}

void move_to_job_frame(mesh::Mesh& mesh, const Job& job)
{
    if (!must_be_moved(mesh.frame, job)) return;
    const Eigen::Isometry3d T_job_part = job.T_part_job->inverse();
    mesh.vertices = ((T_job_part.linear() * mesh.vertices).colwise() + T_job_part.translation()).eval();
    mesh.frame = cloud::Frame::job;
}

void move_to_job_frame(mesh::MeshOrCloud& shape, const Job& job)
{
    std::visit([&](auto& either) { move_to_job_frame(either, job); }, shape);
}

cloud::Cloud in_job_frame(cloud::Cloud cloud, const Job& job)
{
    cloud.frame = job.frame();
    return cloud;
}

} // namespace fettle::job
