// Every effect, one line each: the name of its file and of the function NAME_effect() that describes it.
CATHLAB_EFFECT(respiration)
CATHLAB_EFFECT(test_input)
CATHLAB_EFFECT(test_drive)
CATHLAB_EFFECT(test_material)
CATHLAB_EFFECT(test_constraint)
CATHLAB_EFFECT(test_force)
CATHLAB_EFFECT(test_measure)
