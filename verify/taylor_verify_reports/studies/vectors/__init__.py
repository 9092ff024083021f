"""Questions with right answers and wrong answers, for the judges and simulators of everybody."""
