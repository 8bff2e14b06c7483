% SF_INVERSE_MKP  Invert a hysteresis model exactly: wanted displacement to temperature, say.
%
%   X = SF_INVERSE_MKP(FILE, Y) reads the model file FILE and gives the inputs X that make the outputs Y, sample by
%   sample, from every operator off. X has the shape of Y. [X, STATUS] = ... says where Y lies below (-1) or above
%   (1) every output of the model; 0 is within reach (int8).
%
%   X = SF_INVERSE_MKP(..., NAME, VALUE, ...) with the options
%       'policy'   'hold' (the default): the input rests while the target rests;
%                  'anticipate': it crosses the dead band at once, to where the output starts to move the way that
%                  the target goes next, which is looked up in Y; of a block that gets one sample, 'heading' says it
%       'heading'  that way, where it is known better: 1 rises, -1 falls, 0 hold; one number for each target, or one
%       'band'     reversals of Y up to this size are noise and not followed, in the output's unit; by default 0, with
%                  'anticipate' 1 % of the model's range
%       'load'     the load, of a model that depends on one
%
%   B = SF_INVERSE_MKP('open', FILE) opens a block that remembers; X = SF_INVERSE_MKP(B, Y, ...) goes on from where it
%   stands. 'reset', 'save', 'restore', 'info' and 'close' are those of SF_MKP; each function has blocks of its own.
%
%   A model with a weight below zero has no inverse: hysteron:negativeWeights.
%
%   Example
%       Y = 5 + 3 * sin((0:200) / 20);
%       T = sf_Inverse_MKP('spring.json', Y, 'policy', 'anticipate');
%       max(abs(sf_MKP('spring.json', T) - Y))
%
%   See also SF_MKP.
function varargout = sf_Inverse_MKP(varargin)
error('hysteron:notBuilt', 'sf_Inverse_MKP is not built yet: run octave/build in a shell, or build_hysteron here');
end
