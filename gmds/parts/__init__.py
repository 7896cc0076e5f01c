"""Where on a whole surface a part of it lies: extremities that a cut leaves, trilateration from them, local stress."""
