"""Contact of rough rollers: what meets in the contact window, counted or sampled."""
