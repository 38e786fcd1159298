// Every effect, one line each: the name of its file and of the function NAME_effect() that describes it.  Those that
// use the same hook are asked in this order.
// Between drive and catheter, from the drive to the tip.
CATHLAB_EFFECT(actuation_gain)
CATHLAB_EFFECT(backlash)
CATHLAB_EFFECT(hysteresis)
CATHLAB_EFFECT(actuation_lag)
CATHLAB_EFFECT(tendon_slack)
CATHLAB_EFFECT(segment_coupling)
CATHLAB_EFFECT(rest_memory)
CATHLAB_EFFECT(gravity_sag)
CATHLAB_EFFECT(tip_compliance)
// Heart and body.
CATHLAB_EFFECT(respiration)
CATHLAB_EFFECT(alternans)
CATHLAB_EFFECT(ectopic_beats)
CATHLAB_EFFECT(amplitude_drift)
CATHLAB_EFFECT(rate_variability)
CATHLAB_EFFECT(baseline_wander)
// Wall.
CATHLAB_EFFECT(stiffening)
// What a sensor makes of it.
CATHLAB_EFFECT(sensor_latency)
CATHLAB_EFFECT(registration)
CATHLAB_EFFECT(sensor_drift)
// One for each hook, for tests alone.
CATHLAB_EFFECT(test_input)
CATHLAB_EFFECT(test_actuation)
CATHLAB_EFFECT(test_drive)
CATHLAB_EFFECT(test_material)
CATHLAB_EFFECT(test_constraint)
CATHLAB_EFFECT(test_force)
CATHLAB_EFFECT(test_measure)
