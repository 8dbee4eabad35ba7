//! Steps a scene of rigid bodies
