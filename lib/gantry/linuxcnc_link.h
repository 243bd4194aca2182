#pragma once

#include <Eigen/Core>

#include <array>
#include <memory>
#include <string>

namespace fettle::gantry {

/// The connection to a running LinuxCNC: commands by NML, the head's signals by HAL (samples/machines/linuxcnc).
/// Lengths are the machine's, mm. It sends the heartbeat that the guard requires, as long as this process lives.
class LinuxcncLink {
  public:
    /// @param ini  the file that LinuxCNC was started with
    /// @throws InputError if there is no such file or setting, GantryFault if LinuxCNC does not answer
    explicit LinuxcncLink(const std::string& ini);
    ~LinuxcncLink();
    LinuxcncLink(const LinuxcncLink&) = delete;
    LinuxcncLink& operator=(const LinuxcncLink&) = delete;

    double setting(const std::string& section, const std::string& key) const;

    /// Switches the machine on, homes it if necessary, and lets the guard watch the heartbeat.
    void enable();
    /// Sends a line of G-code and returns when it has started. The motion of the line before may still be running.
    void send_gcode(const std::string& line);
    /// Stops, and discards the lines that were sent.
    void abort();
    /// True if all lines are finished.
    /// @throws GantryFault if the machine is off, the guard has tripped, or LinuxCNC reports an error
    bool done();
    /// Z at which the probe tripped last; NaN if it did not.
    double touched() const;

    Eigen::Vector3d drives() const; ///< position of X, Y, Z, mm
    double deflection() const;      ///< mm
    double force() const;           ///< N
    bool held() const;              ///< by the guard, for more than F_max

    void set_max_force(double force); ///< F_max, N
    void set_hold(bool armed);        ///< the guard holds the feed above F_max
    void set_touch(bool armed);       ///< a contact trips the probe
    void set_tip(bool probe);         ///< the probe is in the place of the wheel
    /// Armed, Z moves between its commanded position and `lowest` so that the spring has this deflection, mm; else it
    /// returns to its commanded position.
    void set_press(bool armed, double deflection = 0, double lowest = 0);

  private:
    struct Wires;
    std::unique_ptr<Wires> wires_;
};

} // namespace fettle::gantry
